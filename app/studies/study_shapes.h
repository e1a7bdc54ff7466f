// Shapes whose distance, gradient and creases are known in closed form.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/types.h"

namespace patina {

struct StudyShape {
  std::string name;
  Box3 bounds;                                    // [m]
  std::function<double(const Vec3&)> distance;    // signed [m]
  std::function<Vec3(const Vec3&)> gradient;      // unit
  std::function<double(const Vec3&)> from_crease; // distance to the nearest sharp edge [m]
};

// A sphere, a torus and a box turned off the axes, each about 0.1 m wide.
std::vector<StudyShape> studyShapes();

} // namespace patina
