#include "authoring/relief/emboss.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "field/surface/iso_surface.h"
#include "geometry/atlas/texel_map.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {

TriangleMesh embossed(std::shared_ptr<const SurfaceField> base, const TriangleMesh& mesh,
                      std::span<const ReliefInput> sources, Progress& progress) {
  progress.report(0, "relief");
  const ReliefBake bake(std::move(base), mesh, sources, progress);
  const auto field = bake.baked(sources);
  progress.throwIfCancelled();
  progress.report(0.5, "surface");
  TriangleMesh surface = isoSurface(*field, 0);
  progress.report(1, "surface");
  return surface;
}

namespace {

constexpr std::size_t kMaxMeasured = 20'000;

struct Displaced {
  Vec3 point;
  double height;
};

void addDisplaced(const TriangleMesh& mesh, const ReliefInput& source,
                  std::vector<Displaced>& points) {
  const TiledImage& image = *source.image;
  const TexelMap texels = texelMap(*source.uvs, image.width(), image.height());
  for (int j = 0; j < image.height(); ++j)
    for (int i = 0; i < image.width(); ++i) {
      const std::int32_t owner = texels.ownerAt(i, j);
      const double height = source.height * static_cast<double>(image.at(i, j, 0));
      if (owner < 0 || height == 0) continue;
      const auto& uv = (*source.uvs)[static_cast<std::size_t>(owner)];
      const std::int32_t face = source.first_face + owner;
      const Vec3 b = texelBarycentric(uv, (i + 0.5) / image.width(), (j + 0.5) / image.height());
      const Vec3 normal = faceNormal(mesh, static_cast<std::size_t>(face));
      points.push_back({position(mesh, {face, b}) + height * normal, height});
    }
}

} // namespace

ReliefDeviation reliefDeviation(const TriangleMesh& mesh, std::span<const ReliefInput> sources,
                                const TriangleMesh& embossed) {
  std::vector<Displaced> points;
  for (const ReliefInput& source : sources)
    if (source.image) addDisplaced(mesh, source, points);
  ReliefDeviation deviation;
  if (points.empty() || embossed.triangles.empty()) return deviation;
  const TriangleTree tree(embossed);
  const std::size_t stride = (points.size() + kMaxMeasured - 1) / kMaxMeasured;
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    deviation.highest = std::max(deviation.highest, std::abs(points[i].height));
    if (i % stride != 0 || !points[i].point.allFinite()) continue;
    const double distance = tree.closestPoint(points[i].point).distance;
    deviation.most = std::max(deviation.most, distance);
    squares += distance * distance;
    ++count;
  }
  deviation.rms = std::sqrt(squares / std::max(count, 1.0));
  return deviation;
}

} // namespace patina
