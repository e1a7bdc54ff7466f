#include "session/build/relief_deviation.h"

#include <algorithm>
#include <cmath>

#include "geometry/atlas/texel_map.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {
namespace {

constexpr std::size_t kMostSamples = 20'000;

struct Displaced {
  Vec3 point;
  double height;
};

void collect(const CompiledScene& compiled, const ReliefSource& source,
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
      const Vec3 normal = faceNormal(*compiled.mesh, static_cast<std::size_t>(face));
      points.push_back({position(*compiled.mesh, {face, b}) + height * normal, height});
    }
}

} // namespace

ReliefDeviation reliefDeviation(const CompiledScene& compiled, const TriangleMesh& embossed) {
  std::vector<Displaced> points;
  for (const ReliefSource& source : reliefSources(compiled))
    if (source.image) collect(compiled, source, points);
  ReliefDeviation deviation;
  if (points.empty() || embossed.triangles.empty()) return deviation;
  const TriangleTree tree(embossed);
  const std::size_t stride = (points.size() + kMostSamples - 1) / kMostSamples;
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
