#include "app/studies/field/field_candidates.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/studies/field/node_gather.h"

namespace patina {
namespace {

using Float4 = float __attribute__((vector_size(16)));

constexpr int kSplineSide = kBlockSide + 2; // nodes -1 .. 8

std::size_t slotFor(const SurfaceField& field, int i, int j, int k) {
  const std::int32_t slot = field.slotOf(i / kBlockSide, j / kBlockSide, k / kBlockSide);
  return static_cast<std::size_t>(std::max(slot, 0));
}

// Coefficients of the interpolating quadratic B-spline of n samples, mirrored at both ends.
void filterRun(float* sample, int n, std::ptrdiff_t stride) {
  if (n < 2) return;
  const double pole = std::sqrt(8.0) - 3;
  const int horizon = std::min(n, 16);
  const auto at = [&](int i) -> float& { return sample[i * stride]; };
  double causal = 0, power = 1;
  for (int i = 0; i < horizon; ++i, power *= pole) causal += power * 8 * static_cast<double>(at(i));
  at(0) = static_cast<float>(causal);
  for (int i = 1; i < n; ++i) {
    causal = 8 * static_cast<double>(at(i)) + pole * causal;
    at(i) = static_cast<float>(causal);
  }
  double back = pole / (pole * pole - 1) *
                (static_cast<double>(at(n - 1)) + pole * static_cast<double>(at(n - 2)));
  at(n - 1) = static_cast<float>(back);
  for (int i = n - 2; i >= 0; --i) {
    back = pole * (back - static_cast<double>(at(i)));
    at(i) = static_cast<float>(back);
  }
}

// Along every row of one axis, each run of stored nodes by itself.
void filterAxis(DenseNodes& nodes, const std::vector<bool>& stored, std::size_t axis) {
  const std::array<std::size_t, 3> n{static_cast<std::size_t>(nodes.size[0]),
                                     static_cast<std::size_t>(nodes.size[1]),
                                     static_cast<std::size_t>(nodes.size[2])};
  const std::array<std::size_t, 3> stride{1, n[0], n[0] * n[1]};
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  for (std::size_t b = 0; b < n[v]; ++b)
    for (std::size_t a = 0; a < n[u]; ++a) {
      const std::size_t row = a * stride[u] + b * stride[v];
      for (std::size_t i = 0; i < n[axis];) {
        std::size_t end = i;
        while (end < n[axis] && stored[row + end * stride[axis]]) ++end;
        filterRun(&nodes.phi[row + i * stride[axis]], static_cast<int>(end - i),
                  static_cast<std::ptrdiff_t>(stride[axis]));
        i = end + 1;
      }
    }
}

} // namespace

TrilinearDerivative::TrilinearDerivative(const SurfaceField& field)
    : field_(&field), phi_(gatherBlocks(field, denseNodes(field), 0, kSampleSide)) {}

std::size_t TrilinearDerivative::bytes() const {
  return phi_.size() * sizeof(float) + field_->top.size() * sizeof(field_->top[0]);
}

CandidateSample TrilinearDerivative::atGrid(const Vec3& q) const noexcept {
  const int i = static_cast<int>(q[0]), j = static_cast<int>(q[1]), k = static_cast<int>(q[2]);
  const float fx = static_cast<float>(q[0] - i), fy = static_cast<float>(q[1] - j),
              fz = static_cast<float>(q[2] - k);
  const float* n = phi_.data() +
                   slotFor(*field_, i, j, k) * kSampleSide * kSampleSide * kSampleSide +
                   ((k % kBlockSide) * kSampleSide + j % kBlockSide) * kSampleSide + i % kBlockSide;
  const float* m = n + kSampleSide * kSampleSide;
  // Rows along x at (y, z) = 00, 10, 01, 11.
  const Float4 low{n[0], n[kSampleSide], m[0], m[kSampleSide]};
  const Float4 high{n[1], n[kSampleSide + 1], m[1], m[kSampleSide + 1]};
  const Float4 dx = high - low, at = low + fx * dx;
  const float ey = 1 - fy, ez = 1 - fz;
  const float y0 = at[0] * ey + at[1] * fy, y1 = at[2] * ey + at[3] * fy;
  CandidateSample sample;
  sample.phi = static_cast<double>(y0 * ez + y1 * fz);
  sample.gradient = Vec3((dx[0] * ey + dx[1] * fy) * ez + (dx[2] * ey + dx[3] * fy) * fz,
                         (at[1] - at[0]) * ez + (at[3] - at[2]) * fz, y1 - y0);
  return sample;
}

QuadraticSpline::QuadraticSpline(const SurfaceField& field) : field_(&field) {
  const auto start = std::chrono::steady_clock::now();
  DenseNodes nodes = denseNodes(field);
  std::vector<bool> stored(nodes.phi.size());
  for (std::size_t n = 0; n < stored.size(); ++n) {
    stored[n] = std::abs(nodes.phi[n]) < kBeyondBand;
    if (!stored[n]) nodes.phi[n] = 0;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) filterAxis(nodes, stored, axis);
  coefficient_ = gatherBlocks(field, nodes, -1, kSplineSide);
  coefficient_.resize(coefficient_.size() + 4); // rows are read four at a time
  build_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::size_t QuadraticSpline::bytes() const {
  return coefficient_.size() * sizeof(float) + field_->top.size() * sizeof(field_->top[0]);
}

CandidateSample QuadraticSpline::atGrid(const Vec3& q) const noexcept {
  const int i = static_cast<int>(q[0] + 0.5), j = static_cast<int>(q[1] + 0.5),
            k = static_cast<int>(q[2] + 0.5);
  const float x = static_cast<float>(q[0] - i), y = static_cast<float>(q[1] - j),
              z = static_cast<float>(q[2] - k);
  const auto weights = [](float t) {
    const float a = 0.5F - t, b = 0.5F + t;
    return std::array<float, 3>{0.5F * a * a, 0.75F - t * t, 0.5F * b * b};
  };
  const auto slopes = [](float t) { return std::array<float, 3>{t - 0.5F, -2 * t, t + 0.5F}; };
  const auto wx = weights(x), wy = weights(y), wz = weights(z);
  const auto sx = slopes(x), sy = slopes(y), sz = slopes(z);

  const float* base =
      coefficient_.data() + slotFor(*field_, i, j, k) * kSplineSide * kSplineSide * kSplineSide +
      ((k % kBlockSide) * kSplineSide + j % kBlockSide) * kSplineSide + i % kBlockSide;
  // Sums over y and z of whole rows: value, slope along y, slope along z.
  Float4 value{}, along_y{}, along_z{};
  for (std::size_t c = 0; c < 3; ++c, base += kSplineSide * kSplineSide) {
    Float4 row_value{}, row_slope{};
    for (std::size_t b = 0; b < 3; ++b) {
      Float4 row;
      __builtin_memcpy(&row, base + b * kSplineSide, sizeof(row));
      row_value += row * wy[b];
      row_slope += row * sy[b];
    }
    value += row_value * wz[c];
    along_y += row_slope * wz[c];
    along_z += row_value * sz[c];
  }
  const auto dot = [](const Float4& row, const std::array<float, 3>& w) {
    return row[0] * w[0] + row[1] * w[1] + row[2] * w[2];
  };
  CandidateSample sample;
  sample.phi = static_cast<double>(dot(value, wx));
  sample.gradient = Vec3(dot(value, sx), dot(along_y, wx), dot(along_z, wx));
  return sample;
}

} // namespace patina
