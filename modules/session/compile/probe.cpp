#include "session/compile/probe.h"

#include "scene/surface_pick.h"

namespace patina {

Probe probeAt(const CompiledScene& scene, const Vec3& p) {
  ClosestPoint closest = Probe{}.closest;
  if (const auto near = surfacePointAt(*scene.built.field, *scene.mesh, p)) {
    closest.surface = *near;
    closest.point = position(*scene.mesh, *near);
    closest.distance = (p - closest.point).norm();
  }
  return probeAt(scene, p, closest);
}

Probe probeAt(const CompiledScene& scene, const Vec3& p, const ClosestPoint& closest) {
  Probe probe;
  probe.position = p;
  probe.closest = closest;
  probe.values.material = baseMaterial(scene.scene.haptics);
  if (!p.allFinite()) {
    probe.distance = std::numeric_limits<double>::quiet_NaN();
    probe.gradient.setConstant(probe.distance);
    return probe;
  }
  const GridSample sample = FieldSampler(*scene.paint.field, scene.scene.sampler).at(p);
  probe.in_band = sample.region == FieldRegion::band;
  probe.distance = sample.phi;
  probe.gradient = sample.gradient;
  if (closest.surface.face < 0) return probe;
  if (!probe.in_band) { // The field only bounds the distance here.
    const double sign = sample.region == FieldRegion::interior ? -1 : 1;
    probe.distance = sign * closest.distance;
    probe.gradient.setZero();
    if (closest.distance > 0) probe.gradient = sign * (p - closest.point) / closest.distance;
  }
  const auto face = static_cast<std::size_t>(closest.surface.face);
  const TriangleMesh& mesh = *scene.mesh;
  const Vec3 at = closestBarycentric(closest.point, mesh.corner(face, 0), mesh.corner(face, 1),
                                     mesh.corner(face, 2));
  if (const auto own = objectPointOf(scene.scene, {closest.surface.face, at})) {
    probe.object = own->object;
    probe.values = surfaceValues(scene.scene, own->object, own->point);
    if (own->object >= scene.paint.objects.size()) return probe;
    const HapticObject& felt = scene.paint.objects[own->object];
    for (const auto& surface : {felt.relief, felt.layer}) {
      if (!surface || !surface->textures) continue;
      const PatchAt patch = surface->textures->at(own->point.face, closest.point);
      if (patch.texture.texture != nullptr) probe.texture = patch.height;
    }
  }
  return probe;
}

} // namespace patina
