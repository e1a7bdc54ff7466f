// Objects painted by a formula, without a brush, so that their pictures can be predicted.
#pragma once

#include <functional>

#include "geometry/atlas/texel_map.h"
#include "geometry/mesh/shapes.h"
#include "scene/scene.h"

namespace patina {

// Sets each texel, gutters included, to the value at its point of the surface.
inline std::shared_ptr<const TiledImage>
imageOf(const TriangleMesh& mesh, const CornerUvs& uvs, int size, int channels,
        const std::function<void(const Vec3&, float*)>& value) {
  auto image = std::make_shared<TiledImage>(size, size, channels);
  const TexelMap texels = texelMap(uvs, size, size);
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) {
      const std::int32_t face = texels.ownerAt(i, j);
      if (face < 0) continue;
      const Vec3 at =
          texelBarycentric(uvs[static_cast<std::size_t>(face)], (i + 0.5) / size, (j + 0.5) / size);
      value(position(mesh, {face, at}),
            image->writable(image->tileOf(i, j)) + image->offsetOf(i, j));
    }
  image->dropEmptyTiles();
  return image;
}

inline SceneObject objectOf(TriangleMesh mesh) {
  SceneObject object;
  object.name = "thing";
  object.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  return object;
}

// Two triangles, z = 0, facing +z, the unit square of the image over its `side`.
inline SceneObject plate(double side) {
  SceneObject object = objectOf(sheet(side, side, 1));
  auto paint = std::make_shared<ObjectPaint>();
  auto uvs = std::make_shared<CornerUvs>();
  for (std::size_t f = 0; f < object.mesh->triangles.size(); ++f) uvs->push_back({});
  for (std::size_t f = 0; f < uvs->size(); ++f)
    for (int k = 0; k < 3; ++k)
      (*uvs)[f][static_cast<std::size_t>(k)] =
          object.mesh->corner(f, k).head<2>() / side + Vec2::Constant(0.5);
  paint->layout.uvs = uvs;
  object.paint = paint;
  return object;
}

inline ObjectPaint paintOf(const SceneObject& object) {
  return object.paint ? *object.paint : ObjectPaint{};
}
inline void setPaint(SceneObject& object, ObjectPaint paint) {
  object.paint = std::make_shared<const ObjectPaint>(std::move(paint));
}

// The values are premultiplied.
inline void ink(float* rgba, const Vec3& color, double cover = 1) {
  for (int c = 0; c < 3; ++c) rgba[c] = static_cast<float>(cover * color[c]);
  rgba[3] = static_cast<float>(cover);
}

// Returns `value` with weight 1 at every node of the box where `where` is true.
inline std::shared_ptr<const MaterialMap>
materialOf(const Box3& box, double voxel, MaterialChannel channel,
           const std::function<double(const Vec3&)>& value,
           const std::function<bool(const Vec3&)>& where) {
  auto map = std::make_shared<MaterialMap>(box.min(), voxel);
  const Eigen::Vector3i nodes = (box.sizes() / voxel).array().ceil().cast<int>() + 1;
  for (int k = 0; k < nodes[2]; ++k)
    for (int j = 0; j < nodes[1]; ++j)
      for (int i = 0; i < nodes[0]; ++i) {
        const Vec3 p = box.min() + voxel * Vec3(i, j, k);
        if (!where(p)) continue;
        MaterialLayer& layer =
            map->writable({i / kMaterialSide, j / kMaterialSide, k / kMaterialSide}, channel);
        const auto n = static_cast<std::size_t>(
            i % kMaterialSide +
            kMaterialSide * (j % kMaterialSide + kMaterialSide * (k % kMaterialSide)));
        layer.value[n] = static_cast<float>(value(p));
        layer.weight[n] = 1;
      }
  return map;
}

} // namespace patina
