#include "session/open/measure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "authoring/brush/painted_patch.h"
#include "core/numbers.h"
#include "geometry/measure/fit_shape.h"
#include "geometry/measure/geodesic.h"
#include "geometry/measure/mesh_part.h"
#include "geometry/mesh/adjacency.h"
#include "scene/surface_pick.h"

namespace patina {
namespace {

std::string millimetres(double metres) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f mm", metres < 1e-3 ? 5 : 3, 1e3 * metres);
  return text;
}

Measurement failure(const std::string& words, const MeasuredPoint& point) {
  return {words, 0, {point.position}, {}, true};
}

Measurement radiusOf(const char* what, double radius, double rms, std::size_t count,
                     const MeasuredPoint& point, const Vec3& centre) {
  return {std::string(what) + " of radius " + millimetres(radius) + ", rms " +
              (rms < 1e-9 ? "0 mm" : formatLength(rms)) + " of " + formatCount(count) + " vertices",
          radius,
          {point.position},
          {centre, point.position},
          false};
}

struct Patch {
  MeshPart part;
  MeshPatch faces; // its numbers are the part's
};

Patch patchOf(const CompiledScene& scene, const MeasuredPoint& point, double radius) {
  const Vec3& at = point.position;
  Patch patch{partWithin(*scene.mesh, at, at, 2 * radius), {}};
  patch.faces = patchAround(patch.part.mesh, adjacency(patch.part.mesh),
                            pointOfPart(patch.part, point.surface), radius);
  return patch;
}

} // namespace

MeasuredPoint measuredPointAt(const CompiledScene& scene, const Vec3& p) {
  const auto surface = surfacePointAt(*scene.built.field, *scene.mesh, p);
  if (!surface) return {p, {}};
  return {position(*scene.mesh, *surface), *surface};
}

Measurement measureDistance(const CompiledScene& scene, const MeasuredPoint& a,
                            const MeasuredPoint& b, const Progress& progress) {
  Measurement found;
  found.value = (b.position - a.position).norm();
  found.words = millimetres(found.value) + " straight";
  found.points = {a.position, b.position};
  found.line = found.points;
  if (a.surface.face < 0 || b.surface.face < 0) return found;
  if (const auto path = geodesicPath(*scene.mesh, a.surface, b.surface, progress)) {
    found.words += ", " + millimetres(path->length) + " along the surface";
    // Both lines are drawn: there straight, and back along the surface.
    found.line.insert(found.line.end(), path->points.rbegin(), path->points.rend());
  }
  return found;
}

Measurement measureAngle(const MeasuredPoint& a, const MeasuredPoint& corner,
                         const MeasuredPoint& b) {
  const Vec3 one = a.position - corner.position, two = b.position - corner.position;
  const double angle = std::atan2(one.cross(two).norm(), one.dot(two));
  char words[64];
  std::snprintf(words, sizeof words, "%.3f°", angle * 180 / M_PI);
  const std::vector<Vec3> points{a.position, corner.position, b.position};
  return {words, angle, points, points, false};
}

Measurement measureSphere(const CompiledScene& scene, const MeasuredPoint& point, double radius) {
  if (point.surface.face < 0) return failure("click a mesh to fit a sphere to it", point);
  const MeshPatch patch = patchOf(scene, point, radius).faces;
  const auto sphere = fitSphere(patch.points);
  if (!sphere)
    return failure("no sphere fits " + formatCount(patch.points.size()) +
                       " vertices: choose a larger patch, or a curved place",
                   point);
  return radiusOf("sphere", sphere->radius, sphere->rms, patch.points.size(), point,
                  sphere->centre);
}

Measurement measureCylinder(const CompiledScene& scene, const MeasuredPoint& point, double radius) {
  if (point.surface.face < 0) return failure("click a mesh to fit a cylinder to it", point);
  const auto [part, patch] = patchOf(scene, point, radius);
  const auto cylinder = fitCylinder(part.mesh, patch);
  if (!cylinder)
    return failure("no cylinder fits " + formatCount(patch.points.size()) +
                       " vertices: choose a larger patch, or a curved place",
                   point);
  const Vec3 off = point.position - cylinder->centre;
  return radiusOf("cylinder", cylinder->radius, cylinder->rms, patch.points.size(), point,
                  cylinder->centre + off.dot(cylinder->axis) * cylinder->axis);
}

Measurement measurePaint(const CompiledScene& scene, const MeasuredPoint& point) {
  const auto own = objectPointOf(scene.scene, point.surface);
  const auto patch = own ? paintedPatchAt(scene.scene, own->object, own->point,
                                          adjacency(*scene.scene.objects[own->object].mesh))
                         : std::nullopt;
  if (!patch) return failure("nothing is painted at this point", point);
  return {formatArea(patch->area) + " painted with " + patch->what,
          patch->area,
          {point.position},
          {},
          false};
}

} // namespace patina
