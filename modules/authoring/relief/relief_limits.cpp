#include "authoring/relief/relief_limits.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/parallel_for.h>

#include "authoring/relief/texel_rows.h"

namespace patina {
namespace {

using Row = std::vector<TexelOnSurface>;

// Returns true if all nine texels show one piece of the surface.
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

// Largest |eigenvalue| of the image's second derivatives along the surface [1/m^2 per image unit].
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

bool isEmptyAbout(const TiledImage& image, int across, int up) {
  for (int j = std::max(0, up - 1); j * kTileSide < image.height() && j <= up + 1; ++j)
    for (int i = std::max(0, across - 1); i < image.tilesAcross() && i <= across + 1; ++i)
      if (image.tile(image.tileOf(i * kTileSide, j * kTileSide))) return false;
  return true;
}

bool isSameAbout(const TiledImage& a, const TiledImage& b, int across, int up) {
  for (int j = std::max(0, up - 1); j * kTileSide < a.height() && j <= up + 1; ++j)
    for (int i = std::max(0, across - 1); i < a.tilesAcross() && i <= across + 1; ++i) {
      const std::size_t tile = a.tileOf(i * kTileSide, j * kTileSide);
      if (a.sharedTile(tile) != b.sharedTile(tile)) return false;
    }
  return true;
}

double worstOfTile(const TexelRows& source, const TiledImage& image, int across, int up) {
  // Texels at the image's border have no nine neighbours.
  const int i0 = std::max(1, across * kTileSide), j0 = std::max(1, up * kTileSide);
  const int i1 = std::min(image.width() - 1, (across + 1) * kTileSide);
  const int j1 = std::min(image.height() - 1, (up + 1) * kTileSide);
  std::array<Row, 3> rows;
  for (Row& row : rows) row.resize(static_cast<std::size_t>(i1 - i0) + 2);
  source.read(i0 - 1, j0 - 1, rows[1]);
  source.read(i0 - 1, j0, rows[2]);
  double worst = 0;
  for (int j = j0; j < j1; ++j) {
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    source.read(i0 - 1, j + 1, rows[2]);
    for (int i = i0; i < i1; ++i) {
      const auto n = static_cast<std::size_t>(i - i0) + 1;
      const TexelOnSurface& texel = rows[1][n];
      if (!texel.inside) continue;
      const double curvature = curvatureAt(image, texel.metric, i, j);
      if (curvature > worst && isWhole(rows, n)) worst = curvature;
    }
  }
  return worst;
}

} // namespace

struct CurvatureMap::Impl {
  std::shared_ptr<const TriangleMesh> mesh;
  std::shared_ptr<const CornerUvs> uvs;
  TexelMap texels;
  std::vector<TexelMetric> metrics;
};

CurvatureMap::CurvatureMap(std::shared_ptr<const TriangleMesh> mesh,
                           std::shared_ptr<const CornerUvs> uvs, int width, int height)
    : impl_(std::make_unique<Impl>()) {
  impl_->texels = texelMap(*uvs, width, height);
  impl_->metrics = texelMetrics(*mesh, *uvs, width, height);
  impl_->mesh = std::move(mesh);
  impl_->uvs = std::move(uvs);
}

CurvatureMap::~CurvatureMap() = default;

bool CurvatureMap::fits(const CornerUvs& uvs, int width, int height) const {
  return impl_->uvs.get() == &uvs && impl_->texels.width == width && impl_->texels.height == height;
}

std::size_t CurvatureMap::bytes() const {
  return impl_->texels.owner.capacity() * sizeof(std::int32_t) +
         impl_->metrics.capacity() * sizeof(TexelMetric);
}

std::vector<float> CurvatureMap::perTile(const TiledImage& image, const TiledImage* before,
                                         const std::vector<float>* known) const {
  std::vector<float> bends(image.tileCount(), 0);
  const bool knows =
      before && known && known->size() == bends.size() && before->tileCount() == image.tileCount();
  const TexelRows source(*impl_->mesh, *impl_->uvs, impl_->texels, impl_->metrics);
  tbb::parallel_for(std::size_t{0}, bends.size(), [&](std::size_t tile) {
    const auto tiles_across = static_cast<std::size_t>(image.tilesAcross());
    const int across = static_cast<int>(tile % tiles_across);
    const int up = static_cast<int>(tile / tiles_across);
    if (isEmptyAbout(image, across, up)) return;
    bends[tile] = knows && isSameAbout(image, *before, across, up)
                      ? (*known)[tile]
                      : static_cast<float>(worstOfTile(source, image, across, up));
  });
  return bends;
}

ReliefLimit reliefLimit(const TriangleMesh& mesh, const TextureLayout& layout,
                        const TiledImage& relief, double height,
                        const std::optional<DeviceModel>& device, double force_limit) {
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
  const std::shared_ptr<const TriangleMesh> borrowed(std::shared_ptr<void>(), &mesh);
  const CurvatureMap map(borrowed, layout.uvs, relief.width(), relief.height());
  const std::vector<float> bends = map.perTile(relief);
  limit.curvature = scale * static_cast<double>(*std::max_element(bends.begin(), bends.end()));
  if (limit.curvature == 0) return limit;
  limit.wavelength = 2 * M_PI * std::sqrt(0.5 * scale * (high - low) / limit.curvature);
  if (device) {
    const double stiffness = 2 * device->damping * device->rate / (1 + 2 * device->delay);
    limit.admissible = limit.highest * stiffness / (force_limit * limit.curvature);
  }
  return limit;
}

} // namespace patina
