#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "authoring/relief_limits.h"
#include "authoring/texel_rows.h"

namespace patina {
namespace {

constexpr double kMostTexels = 64; // deviation, in texels
constexpr double kSqueezed = 4;    // texels a side that stand for one of mean size, at most
constexpr double kLeastValue = 1e-7;
constexpr double kTail = 1e-9; // of the series

// Heat flow through a face: conductances to the neighbours along i, j and both diagonals, and the
// area that a texel has [m^2]. The split keeps all four from being negative, unless a face is
// sheared by more than 45 degrees.
struct Conductance {
  float along_i = 0, along_j = 0, rising = 0, falling = 0, area = 0;

  // At which a texel amid its like cools [1/m^2].
  double rate() const {
    const float sum = 2 * (along_i + along_j + rising + falling);
    return area > 0 ? static_cast<double>(sum / area) : 0.0;
  }
};

// A squeezed texel is taken for a larger one, or it would set the pace for all.
Conductance conductanceOf(const TexelMetric& metric, double most_rate) {
  Conductance c;
  if (!(metric.uu > 0)) return c;
  const float root = std::sqrt(metric.determinant());
  const float uv = -metric.uv / root, shear = std::abs(uv);
  c.along_i = std::max(metric.vv / root - shear, 0.0F);
  c.along_j = std::max(metric.uu / root - shear, 0.0F);
  (uv > 0 ? c.rising : c.falling) = shear;
  c.area = root;
  c.area *= static_cast<float>(std::max(c.rate() / most_rate, 1.0));
  return c;
}

double mostRate(const TriangleMesh& mesh, const CornerUvs& uvs, const TiledImage& image,
                double deviation) {
  double texels = 0;
  for (const auto& uv : uvs) {
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    texels += 0.5 * std::abs(a[0] * b[1] - a[1] * b[0]) * image.width() * image.height();
  }
  const double side =
      std::max(std::sqrt(area(mesh) / std::max(texels, 1.0)) / kSqueezed, deviation / kMostTexels);
  return 4 / (side * side);
}

// e^-rho I_n(rho) for n = 0 .. until kTail, by Miller's downward recurrence.
std::vector<double> besselWeights(double rho) {
  const auto start = static_cast<std::size_t>(24 + std::sqrt(100 * rho));
  std::vector<double> weight(start + 2);
  weight[start] = 1e-200;
  for (std::size_t n = start; n > 0; --n) {
    weight[n - 1] = weight[n + 1] + 2 * static_cast<double>(n) / rho * weight[n];
    if (weight[n - 1] > 1e100) // only the ratios matter
      for (double& w : weight) w *= 1e-200;
  }
  double sum = -weight[0];
  for (const double w : weight) sum += 2 * w;
  for (double& w : weight) w /= sum;
  while (weight.size() > 1 && weight.back() < kTail) weight.pop_back();
  return weight;
}

struct Window {
  int i0 = 0, j0 = 0, width = 0, height = 0;

  std::size_t stride() const { return static_cast<std::size_t>(width) + 2; }
  std::size_t size() const { return stride() * (static_cast<std::size_t>(height) + 2); }
  std::size_t at(int i, int j) const { // -1 .. width, -1 .. height
    return static_cast<std::size_t>(j + 1) * stride() + static_cast<std::size_t>(i + 1);
  }
};

// Of the painted tiles and `reach` texels round them.
Window windowAround(const TiledImage& image, int reach) {
  int i0 = image.width(), j0 = image.height(), i1 = 0, j1 = 0;
  for (int j = 0; j < image.height(); j += kTileSide)
    for (int i = 0; i < image.width(); i += kTileSide) {
      if (!image.tile(image.tileOf(i, j))) continue;
      i0 = std::min(i0, i);
      j0 = std::min(j0, j);
      i1 = std::max(i1, i + kTileSide);
      j1 = std::max(j1, j + kTileSide);
    }
  i0 = std::max(i0 - reach, 0);
  j0 = std::max(j0 - reach, 0);
  i1 = std::min(i1 + reach, image.width());
  j1 = std::min(j1 + reach, image.height());
  return {i0, j0, std::max(i1 - i0, 0), std::max(j1 - j0, 0)};
}

// exp(-time L) by Chebyshev's polynomials on the spectrum [0, 2 rate] of L: a series of weights
// e^-rho I_n(rho), rho = rate * time. Its degree is also how far a texel is seen, so that the
// window, if that much larger than what is painted, does not matter.
class HeatFlow {
 public:
  HeatFlow(const TexelRows& rows, const Window& window, double most_rate)
      : window_(window), east_(window.size()), north_(window.size()), rising_(window.size()),
        falling_(window.size()), per_area_(window.size()) {
    inRows([&](int from, int to) { connect(rows, from, to, most_rate); });
  }

  std::vector<float> apply(const std::vector<float>& values, const std::vector<double>& weight,
                           double rate) const {
    std::vector<float> result(values.size()), before = values, now(values.size()),
                                              next(values.size());
    step(before, before, now, 1 / rate, 1, 0);
    const auto w0 = static_cast<float>(weight[0]);
    for (std::size_t n = 0; n < values.size(); ++n) result[n] = w0 * values[n];
    for (std::size_t degree = 1; degree < weight.size(); ++degree) {
      const auto w = static_cast<float>((degree % 2 ? -2 : 2) * weight[degree]);
      const bool last = degree + 1 == weight.size();
      inRows([&](int from, int to) {
        for (std::size_t n = window_.at(-1, from); n < window_.at(-1, to); ++n)
          result[n] += w * now[n];
      });
      if (last) break;
      step(now, before, next, 2 / rate, 2, 1);
      std::swap(before, now);
      std::swap(now, next);
    }
    return result;
  }

 private:
  template <class Body> void inRows(const Body& body) const {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, window_.height, 16),
        [&](const tbb::blocked_range<int>& range) { body(range.begin(), range.end()); });
  }

  void connect(const TexelRows& rows, int from, int to, double most_rate) {
    std::vector<TexelOnSurface> here(window_.stride()), above(window_.stride());
    rows.read(window_.i0 - 1, window_.j0 + from, here);
    // The row below belongs to another range, and so do the links that rise from it.
    for (int j = from; j < to; ++j, std::swap(here, above)) {
      if (j + 1 < window_.height)
        rows.read(window_.i0 - 1, window_.j0 + j + 1, above);
      else
        for (TexelOnSurface& texel : above) texel.shown = false;
      for (int i = 0; i < window_.width; ++i) {
        const auto n = static_cast<std::size_t>(i) + 1;
        const TexelOnSurface& own = here[n];
        if (!own.shown) continue;
        const Conductance c = conductanceOf(own.metric, most_rate);
        const std::size_t at = window_.at(i, j);
        per_area_[at] = 1 / c.area;
        // The lesser of two: the faces' own rates bound the spectrum.
        const auto link = [&](const TexelOnSurface& other, int di, int dj,
                              float Conductance::*along) {
          if (!TexelRows::joined(own, other, di, dj)) return 0.0F;
          return std::min(c.*along, conductanceOf(other.metric, most_rate).*along);
        };
        if (i + 1 < window_.width) {
          east_[at] = link(here[n + 1], 1, 0, &Conductance::along_i);
          rising_[at] = link(above[n + 1], 1, 1, &Conductance::rising);
        }
        north_[at] = link(above[n], 0, 1, &Conductance::along_j);
        if (i > 0) falling_[at] = link(above[n - 1], -1, 1, &Conductance::falling);
      }
    }
  }

  // next = a L now - b now - c before
  void step(const std::vector<float>& now, const std::vector<float>& before,
            std::vector<float>& next, double a, double b, double c) const {
    const auto fa = static_cast<float>(a), fb = static_cast<float>(b), fc = static_cast<float>(c);
    const std::size_t up = window_.stride();
    inRows([&](int from, int to) {
      for (int j = from; j < to; ++j) {
        const std::size_t end = window_.at(window_.width, j);
        for (std::size_t n = window_.at(0, j); n < end; ++n) {
          const float v = now[n];
          float flow = east_[n] * (v - now[n + 1]) + east_[n - 1] * (v - now[n - 1]);
          flow += north_[n] * (v - now[n + up]) + north_[n - up] * (v - now[n - up]);
          flow += rising_[n] * (v - now[n + up + 1]) + rising_[n - up - 1] * (v - now[n - up - 1]);
          flow +=
              falling_[n] * (v - now[n + up - 1]) + falling_[n - up + 1] * (v - now[n - up + 1]);
          next[n] = fa * (per_area_[n] * flow) - fb * v - fc * before[n];
        }
      }
    });
  }

  const Window window_;
  std::vector<float> east_, north_, rising_, falling_; // to (1,0), (0,1), (1,1), (-1,1)
  std::vector<float> per_area_;                        // 0 where nothing is shown
};

} // namespace

TiledImage smoothed(const TiledImage& relief, const TriangleMesh& mesh, const TextureLayout& layout,
                    const TexelMap& texels, double deviation) {
  if (!(deviation >= 0) || !std::isfinite(deviation))
    throw std::invalid_argument("smoothed: the deviation must not be negative");
  if (texels.width != relief.width() || texels.height != relief.height() || relief.channels() != 1)
    throw std::invalid_argument("smoothed: not the image that the texel map was made for");
  const double time = 0.5 * deviation * deviation;
  const std::vector<TexelMetric> metrics =
      texelMetrics(mesh, *layout.uvs, relief.width(), relief.height());
  const double most_rate = mostRate(mesh, *layout.uvs, relief, deviation);
  double rate = 0;
  for (const TexelMetric& metric : metrics)
    rate = std::max(rate, conductanceOf(metric, most_rate).rate());
  rate *= 1 + 1e-5; // rounding
  if (!(rate * time > 1e-6)) return relief;

  const std::vector<double> weight = besselWeights(rate * time);
  const Window window = windowAround(relief, static_cast<int>(weight.size()));
  if (window.width == 0) return relief;
  const TexelRows rows(mesh, *layout.uvs, texels, metrics);
  std::vector<float> values(window.size());
  for (int j = 0; j < window.height; ++j)
    for (int i = 0; i < window.width; ++i)
      values[window.at(i, j)] = relief.at(window.i0 + i, window.j0 + j, 0);
  values = HeatFlow(rows, window, most_rate).apply(values, weight, rate);

  TiledImage result = relief;
  for (int j = 0; j < window.height; ++j)
    for (int i = 0; i < window.width; ++i) {
      const int x = window.i0 + i, y = window.j0 + j;
      if (texels.ownerAt(x, y) < 0) continue;
      float value = values[window.at(i, j)];
      if (std::abs(value) < kLeastValue) value = 0;
      if (value == 0 && !result.tile(result.tileOf(x, y))) continue;
      result.writable(result.tileOf(x, y))[result.offsetOf(x, y)] = value;
    }
  result.dropEmptyTiles();
  return result;
}

} // namespace patina
