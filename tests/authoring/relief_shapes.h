// Objects with an image round them, for tests of relief.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "authoring/relief_bake.h"
#include "field/build_field.h"
#include "geometry/shapes.h"

namespace patina::test {

using Height = std::function<double(double u, double v)>;

// g at texel centres.
inline std::shared_ptr<TiledImage> reliefImage(int size, const Height& g) {
  auto image = std::make_shared<TiledImage>(size, size, 1);
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) {
      const double value = g((i + 0.5) / size, (j + 0.5) / size);
      if (value != 0)
        image->writable(image->tileOf(i, j))[image->offsetOf(i, j)] = static_cast<float>(value);
    }
  return image;
}

// Each corner's coordinates by its position: `uv` must be continuous on every face.
inline std::shared_ptr<const CornerUvs> uvsBy(const TriangleMesh& mesh,
                                              const std::function<Vec2(const Vec3&)>& uv) {
  auto uvs = std::make_shared<CornerUvs>(mesh.triangles.size());
  for (std::size_t f = 0; f < uvs->size(); ++f)
    for (int c = 0; c < 3; ++c)
      (*uvs)[f][static_cast<std::size_t>(c)] =
          uv(mesh.corner(f, c)).cwiseMax(Vec2::Zero()).cwiseMin(Vec2::Ones());
  return uvs;
}

inline ReliefSource sourceOf(const TriangleMesh& mesh, std::shared_ptr<const CornerUvs> uvs,
                             std::shared_ptr<const TiledImage> image, double height) {
  return {0, static_cast<std::int32_t>(mesh.triangles.size()), std::move(uvs), std::move(image),
          height};
}

inline std::shared_ptr<const SurfaceField> fieldOf(const TriangleMesh& mesh,
                                                   const FieldSpec& spec) {
  Progress progress;
  return buildField(mesh, spec, progress).field;
}

inline ReliefBake bakeOf(const std::shared_ptr<const SurfaceField>& field, const TriangleMesh& mesh,
                         const std::vector<ReliefSource>& sources) {
  Progress progress;
  return ReliefBake(field, mesh, sources, progress);
}

} // namespace patina::test
