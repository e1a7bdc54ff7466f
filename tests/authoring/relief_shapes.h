// Objects wrapped in an image, for tests of relief.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "authoring/relief/relief_bake.h"
#include "field/construction/build_field.h"
#include "field/sampling/field_sampler.h"
#include "geometry/mesh/shapes.h"
#include "support/relief_image.h"

namespace patina::test {

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

inline ReliefInput sourceOf(const TriangleMesh& mesh, std::shared_ptr<const CornerUvs> uvs,
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
                         const std::vector<ReliefInput>& sources) {
  Progress progress;
  return ReliefBake(field, mesh, sources, progress);
}

// Distance to the sign change of phi from `outside` inwards [m].
inline double surfaceAt(const SurfaceField& field, const Vec3& outside, const Vec3& inwards) {
  const FieldSampler sampler(field, Sampler::kim);
  double t = 0;
  while (sampler.at(outside + t * inwards).phi > 0) t += 0.1 * field.grid.voxel;
  double low = t - 0.1 * field.grid.voxel, high = t;
  for (int i = 0; i < 50; ++i) {
    t = 0.5 * (low + high);
    (sampler.at(outside + t * inwards).phi > 0 ? low : high) = t;
  }
  return t;
}

} // namespace patina::test
