#include "authoring/relief/texel_rows.h"

#include <algorithm>

#include <tbb/parallel_for.h>

namespace patina {
namespace {

// Computes barycentric coordinates, also outside. Returns false for a face without area.
bool barycentricAt(const std::array<Vec2, 3>& uv, const Vec2& at, Vec3& w) {
  const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0], p = at - uv[0];
  const double det = a[0] * b[1] - a[1] * b[0];
  if (det == 0) return false;
  w[1] = (p[0] * b[1] - p[1] * b[0]) / det;
  w[2] = (a[0] * p[1] - a[1] * p[0]) / det;
  w[0] = 1 - w[1] - w[2];
  return w.allFinite();
}

} // namespace

std::vector<TexelMetric> texelMetrics(const TriangleMesh& mesh, const CornerUvs& uvs, int width,
                                      int height) {
  std::vector<TexelMetric> metrics(uvs.size());
  tbb::parallel_for(std::size_t{0}, uvs.size(), [&](std::size_t f) {
    Eigen::Matrix<double, 3, 2> edges;
    Eigen::Matrix2d texels;
    for (int c = 0; c < 2; ++c) {
      edges.col(c) = mesh.corner(f, c + 1) - mesh.corner(f, 0);
      texels.col(c) =
          (uvs[f][static_cast<std::size_t>(c) + 1] - uvs[f][0]).cwiseProduct(Vec2(width, height));
    }
    const double det = texels.determinant();
    if (!(std::abs(det) > 1e-12)) return;
    const Eigen::Matrix<double, 3, 2> jacobian = edges * texels.inverse();
    const Eigen::Matrix2d g = jacobian.transpose() * jacobian;
    const TexelMetric metric{static_cast<float>(g(0, 0)), static_cast<float>(g(0, 1)),
                             static_cast<float>(g(1, 1))};
    // Skips slivers whose metric is too inexact in float.
    if (metric.determinant() > 1e-4F * metric.uu * metric.vv) metrics[f] = metric;
  });
  return metrics;
}

TexelRows::TexelRows(const TriangleMesh& mesh, const CornerUvs& uvs, const TexelMap& texels,
                     const std::vector<TexelMetric>& metrics)
    : mesh_(mesh), uvs_(uvs), texels_(texels), metrics_(metrics), middle_(Vec3::Zero()) {
  const Box3 box = bounds(mesh);
  if (!box.isEmpty()) middle_ = box.center();
}

void TexelRows::read(int i0, int j, std::vector<TexelOnSurface>& row) const {
  for (std::size_t n = 0; n < row.size(); ++n) {
    TexelOnSurface& texel = row[n];
    texel.shown = texel.inside = false;
    const int i = i0 + static_cast<int>(n);
    if (i < 0 || j < 0 || i >= texels_.width || j >= texels_.height) continue;
    const std::int32_t owner = texels_.ownerAt(i, j);
    if (owner < 0) continue;
    const auto f = static_cast<std::size_t>(owner);
    if (!(metrics_[f].uu > 0)) continue;
    const Vec2 at((i + 0.5) / texels_.width, (j + 0.5) / texels_.height);
    Vec3 w;
    if (!barycentricAt(uvs_[f], at, w)) continue;
    texel.shown = true;
    texel.inside = w.minCoeff() >= -1e-9;
    if (!texel.inside) w = texelBarycentric(uvs_[f], at[0], at[1]);
    texel.metric = metrics_[f];
    texel.point = (w[0] * mesh_.corner(f, 0) + w[1] * mesh_.corner(f, 1) +
                   w[2] * mesh_.corner(f, 2) - middle_)
                      .cast<float>();
  }
}

bool TexelRows::joined(const TexelOnSurface& a, const TexelOnSurface& b, int di, int dj) {
  constexpr float kFarther = 2; // tolerance over the metric, since neighbouring faces differ
  if (!a.shown || !b.shown) return false;
  const float length = std::max(a.metric.squaredLength(di, dj), b.metric.squaredLength(di, dj));
  return (a.point - b.point).squaredNorm() <= kFarther * kFarther * length;
}

} // namespace patina
