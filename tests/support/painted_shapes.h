// Material maps made by hand, and a slab with an image.
#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "field/construction/build_field.h"
#include "geometry/mesh/shapes.h"
#include "scene/paint/material_map.h"
#include "scene/paint/relief_surface.h"

namespace patina {

// Returns a map whose nodes within `box` [m] hold value(p) with weight 1 (paint that covers).
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

// A box of 40 x 40 x 12 mm whose top is z = 0, with the image mapped from above, and its field.
struct Slab {
  static constexpr double kSide = 0.04;
  std::shared_ptr<const TriangleMesh> mesh;
  std::shared_ptr<const SurfaceField> field;
  std::shared_ptr<const ReliefFaces> faces;
};
inline CornerUvs uvsFromAbove(const TriangleMesh& mesh, double side) {
  CornerUvs uvs(mesh.triangles.size());
  for (std::size_t f = 0; f < uvs.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corner(f, k);
      uvs[f][static_cast<std::size_t>(k)] = Vec2(p.x(), p.y()) / side + Vec2::Constant(0.5);
    }
  return uvs;
}
inline Slab slab(double voxel, int cells = 1, double band = 8) {
  Slab made;
  TriangleMesh mesh = box(Vec3(Slab::kSide, Slab::kSide, 0.012), cells);
  for (Vec3& p : mesh.positions) p.z() -= 0.006;
  FieldSpec spec;
  spec.voxel = voxel;
  spec.band = band;
  Progress progress;
  made.field = withSamples(buildField(mesh, spec, progress).field);
  made.faces = reliefFaces(mesh, uvsFromAbove(mesh, Slab::kSide));
  made.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  return made;
}

// Returns the one with voxels of half a millimetre, made once a program.
inline const Slab& fineSlab() {
  static const Slab made = slab(0.5e-3, 1, 14);
  return made;
}

inline std::shared_ptr<const ReliefSurface> reliefOn(std::shared_ptr<const ReliefFaces> faces,
                                                     std::shared_ptr<const TiledImage> image,
                                                     double height) {
  return std::make_shared<ReliefSurface>(ReliefSurface{std::move(faces), std::move(image), height});
}

inline Box3 cube(double half) {
  return {Vec3::Constant(-half), Vec3::Constant(half)};
}

} // namespace patina
