#include "authoring/relief/relief_smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "authoring/relief/relief_image.h"
#include "authoring/relief/relief_window.h"
#include "authoring/relief/texel_rows.h"

namespace patina {
namespace {

constexpr double kMaxTexels = 64;      // largest deviation [texel]
constexpr double kSqueezed = 4;        // smallest texels count as this fraction of the mean side
constexpr double kMinDeviation = 1.25; // [cell]
constexpr double kLargest = 0.01;      // share of larger texels
constexpr float kMinValue = 1e-7F;
constexpr double kTail = 1e-4; // truncation of the series: kMinValue of a millimetre

// Returns the remaining variance after that of the splines, from a variance of `half` * 2 [m^2].
DiffusionTensor diffusionTensor(const TexelMetric& metric, double half, int side) {
  if (!(metric.uu > 0)) return {};
  const double scale = half / (side * side * static_cast<double>(metric.determinant()));
  const double own = side > 1 ? 0.25 : 0;
  const double ii = scale * static_cast<double>(metric.vv),
               jj = scale * static_cast<double>(metric.uu),
               ij = -scale * static_cast<double>(metric.uv);
  const double mean = 0.5 * (ii + jj) - own, radius = std::hypot(0.5 * (ii - jj), ij);
  const double low = std::max(mean - radius, 0.0), high = std::max(mean + radius, 0.0);
  const double turn = radius > 0 ? 0.5 * (high - low) / radius : 0;
  const double middle = 0.5 * (high + low), half_difference = 0.5 * (ii - jj) * turn;
  return {static_cast<float>(middle + half_difference), static_cast<float>(ij * turn),
          static_cast<float>(middle - half_difference)};
}

double meanTexel(const TriangleMesh& mesh, const CornerUvs& uvs, const TexelMap& image) {
  double texels = 0;
  for (const auto& uv : uvs) {
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    texels += 0.5 * std::abs(a[0] * b[1] - a[1] * b[0]) * image.width * image.height;
  }
  return std::sqrt(area(mesh) / std::max(texels, 1.0));
}

// Returns the cells' side [texels]: as large as the deviation allows where texels are large.
int cellSide(const TriangleMesh& mesh, const std::vector<TexelMetric>& metrics, double deviation) {
  std::vector<std::pair<float, double>> by_size; // longest texel, area
  double all = 0;
  for (std::size_t f = 0; f < metrics.size(); ++f) {
    const TexelMetric& m = metrics[f];
    if (!(m.uu > 0)) continue;
    const float longest = 0.5F * (m.uu + m.vv) + std::hypot(0.5F * (m.uu - m.vv), m.uv);
    const Vec3 a = mesh.corner(f, 1) - mesh.corner(f, 0), b = mesh.corner(f, 2) - mesh.corner(f, 0);
    by_size.emplace_back(longest, 0.5 * a.cross(b).norm());
    all += by_size.back().second;
  }
  std::sort(by_size.begin(), by_size.end(), std::greater<>());
  double larger = 0, longest = 0;
  for (const auto& [size, own] : by_size) {
    longest = std::sqrt(static_cast<double>(size));
    larger += own;
    if (larger > kLargest * all) break;
  }
  int side = 1;
  while (side < kTileSide && deviation >= kMinDeviation * 2 * side * longest) side *= 2;
  return side;
}

// Corrects the fourth-order errors of the stencil (k^4 / 12 of a cell) and of the splines.
double fourthOrderTerm(double half_variance, int side) {
  const double k = std::max(half_variance, 1e-3);
  return std::max(1 / (12 * k) - (side > 1 ? 1 / (640 * k * k) : 0), 0.0);
}

// Returns c_n of sum c_n T_n(lambda / rate - 1), up to kTail, for the decay of waves by diffusion
// for unit time, exp(-lambda - bend lambda^2) on [0, 2 rate]. Preserves constants.
std::vector<double> series(double rate, double bend) {
  const auto count = static_cast<std::size_t>(32 + 4 * std::sqrt(100 * rate));
  std::vector<double> value(count), weight;
  const auto angle = [&](std::size_t j) {
    return M_PI * (static_cast<double>(j) + 0.5) / static_cast<double>(count);
  };
  for (std::size_t j = 0; j < count; ++j) {
    const double lambda = rate * (1 + std::cos(angle(j)));
    value[j] = std::exp(-lambda - bend * lambda * lambda);
  }
  for (std::size_t n = 0; n < count / 2; ++n) {
    double sum = 0;
    for (std::size_t j = 0; j < count; ++j)
      sum += value[j] * std::cos(static_cast<double>(n) * angle(j));
    weight.push_back((n == 0 ? 1.0 : 2.0) * sum / static_cast<double>(count));
  }
  while (weight.size() > 1 && std::abs(weight.back()) < kTail) weight.pop_back();
  double at_rest = 0;
  for (std::size_t n = 0; n < weight.size(); ++n) at_rest += n % 2 ? -weight[n] : weight[n];
  for (double& w : weight) w /= at_rest;
  return weight;
}

TexelBox joined(const TexelBox& a, const TexelBox& b) {
  return {std::min(a.i0, b.i0), std::min(a.j0, b.j0), std::max(a.i1, b.i1), std::max(a.j1, b.j1)};
}

// Merges boxes that cost less together than separately after growing.
std::vector<TexelBox> mergedBoxes(const std::vector<TexelBox>& boxes, int by,
                                  const TexelBox& image) {
  const auto cost = [&](const TexelBox& box) {
    const TexelBox all = grown(box, by, image);
    return static_cast<std::int64_t>(all.i1 - all.i0) * (all.j1 - all.j0);
  };
  std::vector<TexelBox> result;
  for (TexelBox box : boxes) {
    for (std::size_t n = 0; n < result.size();) {
      const TexelBox both = joined(box, result[n]);
      if (cost(both) > cost(box) + cost(result[n])) {
        ++n;
        continue;
      }
      box = both;
      result.erase(result.begin() + static_cast<std::ptrdiff_t>(n));
      n = 0;
    }
    result.push_back(box);
  }
  return result;
}

// Computes next = a L now - b now - c before for `count` texels of a row.
struct Recurrence {
  float a, b, c;
};
void stepRow(const std::array<const float*, kParts>& links, std::size_t up, std::size_t count,
             const float* __restrict now, const float* __restrict before, float* __restrict next,
             const Recurrence& step) {
  const float* __restrict east = links[kEast];
  const float* __restrict north = links[kNorth];
  const float* __restrict diagonal = links[kDiagonal];
  const float* __restrict anti_diagonal = links[kAntiDiagonal];
  const float* __restrict per_area = links[kPerArea];
  const auto row = static_cast<std::ptrdiff_t>(up);
  for (std::ptrdiff_t n = 0; n < static_cast<std::ptrdiff_t>(count); ++n) {
    const float v = now[n];
    float flow = east[n] * (v - now[n + 1]) + east[n - 1] * (v - now[n - 1]);
    flow += north[n] * (v - now[n + row]) + north[n - row] * (v - now[n - row]);
    flow += diagonal[n] * (v - now[n + row + 1]) + diagonal[n - row - 1] * (v - now[n - row - 1]);
    flow += anti_diagonal[n] * (v - now[n + row - 1]) +
            anti_diagonal[n - row + 1] * (v - now[n - row + 1]);
    next[n] = step.a * (per_area[n] * flow) - step.b * v - step.c * before[n];
  }
}

template <class Body> void inRows(const TexelBox& box, const Body& body) {
  constexpr int kTexels = 1 << 14; // smaller work does not pay for a thread
  const int rows = std::max(1, kTexels / std::max(1, width(box)));
  if (box.j1 - box.j0 <= rows) {
    for (int j = box.j0; j < box.j1; ++j) body(j);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<int>(box.j0, box.j1, static_cast<std::size_t>(rows)),
                    [&](const tbb::blocked_range<int>& range) {
                      for (int j = range.begin(); j < range.end(); ++j) body(j);
                    });
}

} // namespace

struct ReliefSmoother::Impl {
  std::shared_ptr<const TriangleMesh> mesh;
  std::shared_ptr<const CornerUvs> uvs;
  std::shared_ptr<const TexelMap> texels;
  std::vector<TexelMetric> metrics;
  int side = 1; // side of a cell [texels]
  double rate = 0;
  // Chebyshev coefficients of exp(-L) on the spectrum [0, 2 rate] of L; empty without smoothing.
  std::vector<double> weight;
  mutable std::mutex mutex;
  mutable std::unique_ptr<ReliefCells> cells;

  int degree() const { return static_cast<int>(weight.size()) - 1; }
  int splineReach() const { return side > 1 ? 1 : 0; }
  int reach() const { return degree() + 2 * splineReach(); } // [cell]
  TexelBox image() const { return {0, 0, texels->width / side, texels->height / side}; }

  // Sums the weighted Chebyshev terms T_n for the cells of `out`. At step n only cells within
  // degree() - n of `out` are needed.
  std::vector<float> flow(std::vector<float> before, const ReliefWindow& window,
                          const TexelBox& out) const {
    std::vector<float> result(before.size()), now(before.size()), next(before.size());
    const auto add = [&](double factor, const std::vector<float>& values, std::size_t from,
                         std::size_t to) {
      const auto w = static_cast<float>(factor);
      for (std::size_t n = from; n < to; ++n) result[n] += w * values[n];
    };
    for (int j = out.j0; j < out.j1; ++j)
      add(weight[0], before, window.at(out.i0, j), window.at(out.i1, j));
    add(weight[0], before, window.grid(), window.size());
    // before, now and next are T_(n-2), T_(n-1) and T_n, except at the first step.
    for (int n = 1; n <= degree(); ++n) {
      const bool first = n == 1;
      const Recurrence step{static_cast<float>((first ? 1 : 2) / rate), first ? 1.0F : 2.0F,
                            first ? 0.0F : 1.0F};
      const double w = weight[static_cast<std::size_t>(n)];
      const std::vector<float>& source = first ? before : now;
      const TexelBox need = grown(out, degree() - n, image());
      const bool with_parts = window.size() > window.grid();
      const auto addRow = [&](int j) {
        if (j >= out.j0 && j < out.j1) add(w, next, window.at(out.i0, j), window.at(out.i1, j));
      };
      inRows(need, [&](int j) {
        const std::size_t at = window.at(need.i0, j);
        std::array<const float*, kParts> links_here{};
        for (std::size_t p = 0; p < kParts; ++p) links_here[p] = &window.parts()[p][at];
        stepRow(links_here, window.stride(), static_cast<std::size_t>(width(need)), &source[at],
                &before[at], &next[at], step);
        if (!with_parts) addRow(j);
      });
      if (with_parts) {
        for (std::size_t cell = window.grid(); cell < window.size(); ++cell)
          next[cell] = -step.b * source[cell] - step.c * before[cell];
        const std::vector<float>& per_area = window.parts()[kPerArea];
        for (const ReliefWindow::Link& link : window.links()) {
          const float flow = step.a * link.conductance * (source[link.a] - source[link.b]);
          next[link.a] += per_area[link.a] * flow;
          next[link.b] -= per_area[link.b] * flow;
        }
        for (int j = out.j0; j < out.j1; ++j) addRow(j);
        add(w, next, window.grid(), window.size());
      }
      if (!first) std::swap(before, now);
      std::swap(now, next);
    }
    return result;
  }

  // Writes the smoothed cells of `out` to `result`.
  void smooth(const TiledImage& relief, const TexelBox& out, TiledImage& result) const {
    const ReliefWindow window = [&] {
      const TexelBox squares = grown(out, reach(), image());
      const int across = cells->squares();
      const std::lock_guard lock(mutex);
      cells->make({squares.i0 / across, squares.j0 / across, (squares.i1 + across - 1) / across,
                   (squares.j1 + across - 1) / across});
      return ReliefWindow(*cells, squares);
    }();
    const std::vector<float> values =
        flow(window.restrict(relief), window, grown(out, splineReach(), image()));
    ReliefWindow::TileValues made;
    forTiles(scaled(out, side), kTileSide, [&](const TexelBox& part) {
      window.prolong(values, part, made);
      const std::size_t index = relief.tileOf(part.i0, part.j0);
      const float* source = relief.tile(index);
      const float* held = result.tile(index);
      float* own = nullptr;
      const auto count = static_cast<std::size_t>(width(part));
      std::array<float, kTileSide> row, old{};
      for (int j = part.j0; j < part.j1; ++j) {
        const std::size_t at = relief.offsetOf(part.i0, j);
        const std::int32_t* owner =
            &texels->owner[static_cast<std::size_t>(j) * static_cast<std::size_t>(texels->width) +
                           static_cast<std::size_t>(part.i0)];
        for (std::size_t n = 0; n < count; ++n)
          row[n] = std::abs(made[at + n]) < kMinValue ? 0 : made[at + n];
        for (std::size_t n = 0; n < count; ++n)
          if (owner[n] < 0) row[n] = source ? source[at + n] : 0;
        if (held) std::copy_n(held + at, count, old.begin());
        if (std::memcmp(row.data(), old.data(), count * sizeof(float)) == 0) continue;
        if (!own) held = own = result.writable(index);
        std::copy_n(row.begin(), count, own + at);
      }
    });
  }
};

ReliefSmoother::ReliefSmoother(std::shared_ptr<const TriangleMesh> mesh,
                               std::shared_ptr<const CornerUvs> uvs,
                               std::shared_ptr<const TexelMap> texels, double deviation)
    : impl_(std::make_unique<Impl>()) {
  if (!(deviation >= 0) || !std::isfinite(deviation))
    throw std::invalid_argument("ReliefSmoother: the deviation must not be negative");
  Impl& made = *impl_;
  made.metrics = texelMetrics(*mesh, *uvs, texels->width, texels->height);
  made.side = cellSide(*mesh, made.metrics, deviation);
  // Enlarges very small texels, which would determine the number of steps for all.
  const double least =
      made.side * std::max(meanTexel(*mesh, *uvs, *texels) / kSqueezed, deviation / kMaxTexels);
  const double max_rate = 2 * deviation * deviation / (least * least);
  std::vector<DiffusionTensor> tensors(made.metrics.size());
  double mean = 0, faces = 0;
  for (std::size_t f = 0; f < tensors.size(); ++f) {
    DiffusionTensor& tensor = tensors[f];
    tensor = diffusionTensor(made.metrics[f], 0.5 * deviation * deviation, made.side);
    const double rate = maxDecayRate(tensor);
    const auto less = static_cast<float>(std::min(1.0, max_rate / std::max(rate, 1e-30)));
    tensor = {less * tensor.ii, less * tensor.ij, less * tensor.jj};
    made.rate = std::max(made.rate, std::min(rate, max_rate));
    const Vec3 a = mesh->corner(f, 1) - mesh->corner(f, 0),
               b = mesh->corner(f, 2) - mesh->corner(f, 0);
    const double own = a.cross(b).norm();
    mean += own * 0.5 * static_cast<double>(tensor.ii + tensor.jj);
    faces += own;
  }
  made.rate *= 1 + 1e-5; // margin for rounding
  if (made.rate > 1e-6) made.weight = series(made.rate, fourthOrderTerm(mean / faces, made.side));
  made.mesh = std::move(mesh);
  made.uvs = std::move(uvs);
  made.texels = std::move(texels);
  made.cells = std::make_unique<ReliefCells>(*made.mesh, *made.uvs, *made.texels, made.metrics,
                                             std::move(tensors), made.side);
}

ReliefSmoother::~ReliefSmoother() = default;

TiledImage ReliefSmoother::smoothed(const TiledImage& relief) const {
  const TiledImage none(relief.width(), relief.height(), 1);
  return updateSmoothed(none, none, relief);
}

TiledImage ReliefSmoother::updateSmoothed(const TiledImage& result, const TiledImage& before,
                                          const TiledImage& relief) const {
  const TexelMap& texels = *impl_->texels;
  for (const TiledImage* image : {&result, &before, &relief})
    if (image->width() != texels.width || image->height() != texels.height ||
        image->channels() != 1)
      throw std::invalid_argument("ReliefSmoother: not an image that the texel map was made for");
  if (impl_->weight.empty()) return relief;
  TiledImage made = result;
  const int reach = impl_->reach(), side = impl_->side;
  std::vector<TexelBox> squares;
  for (const TexelBox& box : changedTexels(before, relief))
    squares.push_back(
        {box.i0 / side, box.j0 / side, (box.i1 + side - 1) / side, (box.j1 + side - 1) / side});
  constexpr int kAtOnce = 512; // [squares a side], bounds the memory
  for (const TexelBox& box : mergedBoxes(squares, 2 * reach, impl_->image()))
    forTiles(grown(box, reach, impl_->image()), kAtOnce,
             [&](const TexelBox& part) { impl_->smooth(relief, part, made); });
  return made;
}

const std::shared_ptr<const TexelMap>& ReliefSmoother::texels() const {
  return impl_->texels;
}

std::size_t ReliefSmoother::bytes() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->cells->bytes() + impl_->metrics.size() * sizeof(TexelMetric) +
         impl_->texels->owner.size() * sizeof(impl_->texels->owner[0]);
}

} // namespace patina
