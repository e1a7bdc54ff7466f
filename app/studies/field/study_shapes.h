// Shapes with exact distances, on which fields and merged surfaces are measured.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/types.h"

namespace patina {

// Shapes whose distance, gradient and creases have closed forms.
struct StudyShape {
  std::string name;
  Box3 bounds;                                    // [m]
  std::function<double(const Vec3&)> distance;    // signed [m]
  std::function<Vec3(const Vec3&)> gradient;      // unit
  std::function<double(const Vec3&)> from_crease; // distance to the nearest sharp edge [m]
};

// A sphere, a torus and a box rotated off the axes, each about 0.1 m wide.
std::vector<StudyShape> studyShapes();

// Depth of a point inside the union of two spheres of radius R at x = +-a, 0 < a < R: the distance
// to the union's surface, on a sphere or on the circle where both meet (F9).
double lensDepth(const Vec3& p, double radius, double a);

} // namespace patina
