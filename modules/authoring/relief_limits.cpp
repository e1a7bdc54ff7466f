#include "authoring/relief_limits.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "authoring/texel_rows.h"

namespace patina {
namespace {

using Row = std::vector<TexelOnSurface>;

bool rowIsEmpty(const TiledImage& image, int j) {
  for (int i = 0; i < image.width(); i += kTileSide)
    if (image.tile(image.tileOf(i, j))) return false;
  return true;
}

// All nine texels show one piece of the surface.
bool isWhole(const std::array<Row, 3>& rows, std::size_t i) {
  const TexelOnSurface& middle = rows[1][i];
  if (!middle.inside) return false;
  for (int dj = -1; dj <= 1; ++dj)
    for (int di = -1; di <= 1; ++di) {
      const TexelOnSurface& other =
          rows[static_cast<std::size_t>(dj + 1)][i + static_cast<std::size_t>(di + 1) - 1];
      if (!other.inside || !TexelRows::joined(middle, other, di, dj)) return false;
    }
  return true;
}

// Largest |eigenvalue| of the second derivatives g of the image along the surface [1/m^2 of g].
double curvatureAt(const TiledImage& image, const TexelMetric& metric, int i, int j) {
  const auto g = [&](int di, int dj) { return static_cast<double>(image.at(i + di, j + dj, 0)); };
  const double here = 2 * g(0, 0), uu = g(-1, 0) - here + g(1, 0), vv = g(0, -1) - here + g(0, 1);
  const double uv = 0.25 * (g(1, 1) - g(1, -1) - g(-1, 1) + g(-1, -1));
  if (uu == 0 && vv == 0 && uv == 0) return 0;
  const double e = metric.uu, f = metric.uv, h = metric.vv, det = e * h - f * f;
  const double mean = 0.5 * (uu * h - 2 * uv * f + vv * e) / det,
               product = (uu * vv - uv * uv) / det;
  return std::abs(mean) + std::sqrt(std::max(mean * mean - product, 0.0));
}

double worstCurvature(const TriangleMesh& mesh, const CornerUvs& uvs, const TiledImage& image) {
  const TexelMap texels = texelMap(uvs, image.width(), image.height());
  const std::vector<TexelMetric> metrics = texelMetrics(mesh, uvs, texels.width, texels.height);
  const TexelRows source(mesh, uvs, texels, metrics);
  const auto rows_of = [&](const tbb::blocked_range<int>& range, double worst) {
    std::array<Row, 3> rows;
    for (Row& row : rows) row.resize(static_cast<std::size_t>(image.width()));
    int next = -1; // of the rows to read
    for (int j = range.begin(); j < range.end(); ++j) {
      if (rowIsEmpty(image, j - 1) && rowIsEmpty(image, j) && rowIsEmpty(image, j + 1)) continue;
      if (next != j + 1) {
        source.read(0, j - 1, rows[1]);
        source.read(0, j, rows[2]);
      }
      std::rotate(rows.begin(), rows.begin() + 1, rows.end());
      source.read(0, j + 1, rows[2]);
      next = j + 2;
      for (int i = 1; i + 1 < image.width(); ++i) {
        const TexelOnSurface& texel = rows[1][static_cast<std::size_t>(i)];
        if (!texel.inside) continue;
        const double curvature = curvatureAt(image, texel.metric, i, j);
        if (curvature > worst && isWhole(rows, static_cast<std::size_t>(i))) worst = curvature;
      }
    }
    return worst;
  };
  return tbb::parallel_reduce(tbb::blocked_range<int>(1, image.height() - 1, 32), 0.0, rows_of,
                              [](double a, double b) { return std::max(a, b); });
}

} // namespace

ReliefLimit reliefLimit(const TriangleMesh& mesh, const TextureLayout& layout,
                        const TiledImage& relief, double height,
                        const std::optional<DeviceModel>& device) {
  double low = 0, high = 0;
  for (std::size_t t = 0; t < relief.tileCount(); ++t)
    if (const auto& tile = relief.sharedTile(t)) {
      const auto [least, most] = std::minmax_element(tile->begin(), tile->end());
      low = std::min(low, static_cast<double>(*least));
      high = std::max(high, static_cast<double>(*most));
    }
  const double scale = std::abs(height);
  ReliefLimit limit;
  limit.highest = scale * std::max(high, -low);
  if (limit.highest == 0) return limit;
  limit.curvature = scale * worstCurvature(mesh, *layout.uvs, relief);
  if (limit.curvature == 0) return limit;
  limit.wavelength = 2 * M_PI * std::sqrt(0.5 * scale * (high - low) / limit.curvature);
  if (device) {
    const double stiffness = 2 * device->damping * device->rate / (1 + 2 * device->delay);
    limit.admissible = limit.highest * stiffness / limit.curvature; // at P = 1 N
  }
  return limit;
}

} // namespace patina
