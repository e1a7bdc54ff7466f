// Material maps and reliefs made by hand, for the tests of what is painted.
#pragma once

#include "field/build_field.h"
#include "geometry/shapes.h"
#include "haptics/contact_fixture.h"

namespace patina {

// A map whose nodes within `box` [m] hold value(p) with weight 1 (paint that covers).
inline std::shared_ptr<MaterialMap> coveredMap(double voxel, const Box3& box,
                                               MaterialChannel channel,
                                               const std::function<double(const Vec3&)>& value,
                                               std::shared_ptr<MaterialMap> map = nullptr) {
  if (!map) map = std::make_shared<MaterialMap>(Vec3::Zero(), voxel);
  const auto low = [&](int a) { return static_cast<int>(std::ceil(box.min()[a] / voxel)); };
  const auto high = [&](int a) { return static_cast<int>(std::floor(box.max()[a] / voxel)); };
  for (int k = low(2); k <= high(2); ++k)
    for (int j = low(1); j <= high(1); ++j)
      for (int i = low(0); i <= high(0); ++i) {
        MaterialLayer& layer = map->writable({i >> 3, j >> 3, k >> 3}, channel);
        const auto n = static_cast<std::size_t>((k & 7) * 64 + (j & 7) * 8 + (i & 7));
        layer.value[n] = static_cast<float>(value(voxel * Vec3(i, j, k)));
        layer.weight[n] = 1;
      }
  return map;
}

inline FeltObject feltMaterial(const MaterialMap& map, const Scene& scene) {
  FeltObject object;
  object.material = materialSamples(map, baseMaterial(scene.haptics), nullptr, nullptr);
  return object;
}

inline Box3 cube(double half) {
  return {Vec3::Constant(-half), Vec3::Constant(half)};
}

} // namespace patina
