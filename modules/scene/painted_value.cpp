#include "scene/painted_value.h"

#include <cmath>

namespace patina {
namespace {

bool nearPaint(const MaterialMap& map, const Vec3& p) {
  const Vec3 q = (p - map.origin()) / map.voxel();
  if (!q.allFinite() || q.cwiseAbs().maxCoeff() > 1e9) return false;
  // The cell's nodes lie in at most two blocks along each axis.
  for (int corner = 0; corner < 8; ++corner) {
    MaterialMap::Index block{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      block[axis] = static_cast<std::int32_t>(std::floor(
          (std::floor(q[static_cast<int>(axis)]) + (corner >> axis & 1)) / kMaterialSide));
    if (map.blocks().contains(block)) return true;
    if (corner == 0 &&
        (q.array() - kMaterialSide * (q / kMaterialSide).array().floor()).maxCoeff() <
            kMaterialSide - 1)
      return false;
  }
  return false;
}

} // namespace

PaintedValue paintedValue(const Scene& scene, MaterialChannel channel, const Vec3& world) {
  const Material base = baseMaterial(scene.haptics);
  PaintedValue best{0, valueOf(base, channel)};
  for (const SceneObject& object : scene.objects) {
    if (!object.paint || !object.paint->material) continue;
    const MaterialMap& map = *object.paint->material;
    const Vec3 p = object.world_from_object.inverse() * world;
    if (!nearPaint(map, p)) continue;
    const MaterialMap::Paint paint = map.paintAt(p, channel);
    const double own = valueOf(base, channel);
    // Added paint has no weight of its own; its part of the sum is used instead.
    const double size = std::abs(paint.value);
    const double weight = paint.weight == 0 && size > 0 ? size / (size + own) : paint.weight;
    if (weight > best.weight) best = {weight, valueOf(map.at(p, base), channel)};
  }
  return best;
}

} // namespace patina
