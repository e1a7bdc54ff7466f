// Measurements between points of a compiled scene.
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "session/compile/compile_scene.h"

namespace patina {

struct MeasuredPoint {
  Vec3 position = Vec3::Zero(); // [m]
  SurfacePoint surface;         // point of the scene's mesh; face -1: not on it
};

struct Measurement {
  std::string words;        // "100 mm straight, 112.5 mm along the surface"
  double value = 0;         // straight length [m], angle [rad], radius [m] or area [m²]
  std::vector<Vec3> points; // the clicked points
  std::vector<Vec3> line;   // to be drawn
  bool failed = false;      // the words say why
};

// Returns the point of the mesh nearest to `p`, which lies on the surface to about a voxel.
MeasuredPoint measuredPointAt(const CompiledScene& scene, const Vec3& p);

// Measures straight and, if both points lie on the mesh, along a geodesic. Throws Cancelled.
Measurement measureDistance(const CompiledScene& scene, const MeasuredPoint& a,
                            const MeasuredPoint& b, const Progress& progress = Progress());
// The angle is the one at the second point.
Measurement measureAngle(const MeasuredPoint& a, const MeasuredPoint& corner,
                         const MeasuredPoint& b);
// Fits a sphere or a cylinder to the vertices within `radius` [m]; see patchAround().
Measurement measureSphere(const CompiledScene& scene, const MeasuredPoint& point, double radius);
Measurement measureCylinder(const CompiledScene& scene, const MeasuredPoint& point, double radius);
// Returns the area of the painted patch about the point; see paintedPatchAt().
Measurement measurePaint(const CompiledScene& scene, const MeasuredPoint& point);

} // namespace patina
