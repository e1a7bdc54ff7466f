#include "authoring/relief_smoothing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "authoring/relief_image.h"
#include "authoring/texel_rows.h"

namespace patina {
namespace {

constexpr double kMostTexels = 64; // deviation, in texels
constexpr double kSqueezed = 4;    // texels a side that stand for one of mean size, at most
constexpr double kLeastValue = 1e-7;
constexpr double kTail = 1e-8; // of the series

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

double mostRate(const TriangleMesh& mesh, const CornerUvs& uvs, const TexelMap& image,
                double deviation) {
  double texels = 0;
  for (const auto& uv : uvs) {
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    texels += 0.5 * std::abs(a[0] * b[1] - a[1] * b[0]) * image.width * image.height;
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

int width(const TexelBox& box) {
  return box.i1 - box.i0;
}

TexelBox grown(const TexelBox& box, int by, const TexelMap& image) {
  return {std::max(box.i0 - by, 0), std::max(box.j0 - by, 0), std::min(box.i1 + by, image.width),
          std::min(box.j1 + by, image.height)};
}

TexelBox joined(const TexelBox& a, const TexelBox& b) {
  return {std::min(a.i0, b.i0), std::min(a.j0, b.j0), std::max(a.i1, b.i1), std::max(a.j1, b.j1)};
}

// Boxes that cost less together than each by itself, once grown, as one.
std::vector<TexelBox> gathered(const std::vector<TexelBox>& boxes, int by, const TexelMap& image) {
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

// Of a texel to its neighbours at (1,0), (0,1), (1,1), (-1,1); per_area is 0 where nothing is
// shown.
enum Part : std::size_t { kEast, kNorth, kRising, kFalling, kPerArea, kParts };
using TileLinks = std::array<std::array<float, kTileSide * kTileSide>, kParts>;

// The part of the image that a call looks at, with a border of nothing a texel wide.
class Window {
 public:
  explicit Window(const TexelBox& box)
      : box_(box), stride_(static_cast<std::size_t>(width(box)) + 2),
        size_(stride_ * static_cast<std::size_t>(box.j1 - box.j0 + 2)) {}
  const TexelBox& box() const { return box_; }
  std::size_t stride() const { return stride_; }
  std::size_t size() const { return size_; }
  std::size_t at(int i, int j) const { // texels of the image
    return static_cast<std::size_t>(j - box_.j0 + 1) * stride_ +
           static_cast<std::size_t>(i - box_.i0 + 1);
  }

 private:
  TexelBox box_;
  std::size_t stride_, size_;
};

// next = a L now - b now - c before, for `count` texels of a row.
struct Recurrence {
  float a, b, c;
};
void stepRow(const std::array<const float*, kParts>& links, std::size_t up, std::size_t count,
             const float* __restrict now, const float* __restrict before, float* __restrict next,
             const Recurrence& step) {
  const float* __restrict east = links[kEast];
  const float* __restrict north = links[kNorth];
  const float* __restrict rising = links[kRising];
  const float* __restrict falling = links[kFalling];
  const float* __restrict per_area = links[kPerArea];
  const auto row = static_cast<std::ptrdiff_t>(up);
  for (std::ptrdiff_t n = 0; n < static_cast<std::ptrdiff_t>(count); ++n) {
    const float v = now[n];
    float flow = east[n] * (v - now[n + 1]) + east[n - 1] * (v - now[n - 1]);
    flow += north[n] * (v - now[n + row]) + north[n - row] * (v - now[n - row]);
    flow += rising[n] * (v - now[n + row + 1]) + rising[n - row - 1] * (v - now[n - row - 1]);
    flow += falling[n] * (v - now[n + row - 1]) + falling[n - row + 1] * (v - now[n - row + 1]);
    next[n] = step.a * (per_area[n] * flow) - step.b * v - step.c * before[n];
  }
}

template <class Body> void inRows(const TexelBox& box, const Body& body) {
  constexpr int kTexels = 1 << 14; // less is not worth a thread
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

template <class Body> void forTiles(const TexelBox& box, const Body& body) {
  for (int j = box.j0 / kTileSide; j * kTileSide < box.j1; ++j)
    for (int i = box.i0 / kTileSide; i * kTileSide < box.i1; ++i) {
      const int x = i * kTileSide, y = j * kTileSide;
      body(TexelBox{std::max(box.i0, x), std::max(box.j0, y), std::min(box.i1, x + kTileSide),
                    std::min(box.j1, y + kTileSide)});
    }
}

std::size_t placeInTile(int i, int j) {
  return static_cast<std::size_t>((j % kTileSide) * kTileSide + i % kTileSide);
}

} // namespace

struct ReliefSmoother::Impl {
  std::shared_ptr<const TriangleMesh> mesh;
  std::shared_ptr<const CornerUvs> uvs;
  std::shared_ptr<const TexelMap> texels;
  std::vector<TexelMetric> metrics;
  double most_rate = 0, rate = 0;
  // exp(-time L) by Chebyshev's polynomials on the spectrum [0, 2 rate] of L: a series of weights
  // e^-rho I_n(rho), rho = rate * time. Its degree is also how far a texel is seen. Empty: nothing
  // is smoothed.
  std::vector<double> weight;
  mutable std::mutex mutex; // of what follows
  mutable std::vector<std::unique_ptr<const TileLinks>> links;

  int reach() const { return static_cast<int>(weight.size()) - 1; }
  int across() const { return texels->width / kTileSide; }
  std::size_t tileOf(const TexelBox& in) const {
    return static_cast<std::size_t>(in.j0 / kTileSide) * static_cast<std::size_t>(across()) +
           static_cast<std::size_t>(in.i0 / kTileSide);
  }

  std::unique_ptr<const TileLinks> linksOf(std::size_t tile) const {
    auto made = std::make_unique<TileLinks>();
    const int i0 = static_cast<int>(tile) % across() * kTileSide,
              j0 = static_cast<int>(tile) / across() * kTileSide;
    const TexelRows rows(*mesh, *uvs, *texels, metrics);
    std::vector<TexelOnSurface> here(kTileSide + 2), above(kTileSide + 2);
    rows.read(i0 - 1, j0, here);
    for (int j = 0; j < kTileSide; ++j, std::swap(here, above)) {
      rows.read(i0 - 1, j0 + j + 1, above);
      for (int i = 0; i < kTileSide; ++i) {
        const auto n = static_cast<std::size_t>(i) + 1;
        const TexelOnSurface& own = here[n];
        if (!own.shown) continue;
        const Conductance c = conductanceOf(own.metric, most_rate);
        // The lesser of two: the faces' own rates bound the spectrum.
        const auto link = [&](const TexelOnSurface& other, int di, int dj,
                              float Conductance::*along) {
          if (!TexelRows::joined(own, other, di, dj)) return 0.0F;
          return std::min(c.*along, conductanceOf(other.metric, most_rate).*along);
        };
        const std::size_t at = placeInTile(i, j);
        (*made)[kPerArea][at] = 1 / c.area;
        (*made)[kEast][at] = link(here[n + 1], 1, 0, &Conductance::along_i);
        (*made)[kNorth][at] = link(above[n], 0, 1, &Conductance::along_j);
        (*made)[kRising][at] = link(above[n + 1], 1, 1, &Conductance::rising);
        (*made)[kFalling][at] = link(above[n - 1], -1, 1, &Conductance::falling);
      }
    }
    return made;
  }

  std::array<std::vector<float>, kParts> linksIn(const Window& window) const {
    std::array<std::vector<float>, kParts> all;
    for (std::vector<float>& part : all) part.resize(window.size());
    std::vector<std::size_t> missing;
    const std::lock_guard lock(mutex);
    forTiles(window.box(), [&](const TexelBox& part) {
      if (!links[tileOf(part)]) missing.push_back(tileOf(part));
    });
    tbb::parallel_for(std::size_t{0}, missing.size(),
                      [&](std::size_t n) { links[missing[n]] = linksOf(missing[n]); });
    forTiles(window.box(), [&](const TexelBox& part) {
      const TileLinks& tile = *links[tileOf(part)];
      for (std::size_t p = 0; p < kParts; ++p)
        for (int j = part.j0; j < part.j1; ++j)
          std::copy_n(&tile[p][placeInTile(part.i0, j)], width(part),
                      &all[p][window.at(part.i0, j)]);
    });
    return all;
  }

  // Of the texels of `out`; the window is that, grown by reach(). What lies farther off an `out`
  // by n is of no use n steps before the last.
  std::vector<float> flow(std::vector<float> before, const Window& window,
                          const TexelBox& out) const {
    const std::array<std::vector<float>, kParts> parts = linksIn(window);
    std::vector<float> result(window.size()), now(window.size()), next(window.size());
    for (int j = out.j0; j < out.j1; ++j)
      for (std::size_t n = window.at(out.i0, j); n < window.at(out.i1, j); ++n)
        result[n] = static_cast<float>(weight[0]) * before[n];
    // before, now and next are T_(n-2), T_(n-1) and T_n of the values, but at the first step.
    for (int degree = 1; degree <= reach(); ++degree) {
      const bool first = degree == 1;
      const Recurrence step{static_cast<float>((first ? 1 : 2) / rate), first ? 1.0F : 2.0F,
                            first ? 0.0F : 1.0F};
      const auto w =
          static_cast<float>((degree % 2 ? -2 : 2) * weight[static_cast<std::size_t>(degree)]);
      const std::vector<float>& source = first ? before : now;
      const TexelBox need = grown(out, reach() - degree, *texels);
      inRows(need, [&](int j) {
        const std::size_t at = window.at(need.i0, j);
        std::array<const float*, kParts> links_here{};
        for (std::size_t p = 0; p < kParts; ++p) links_here[p] = &parts[p][at];
        stepRow(links_here, window.stride(), static_cast<std::size_t>(width(need)), &source[at],
                &before[at], &next[at], step);
        if (j < out.j0 || j >= out.j1) return;
        for (std::size_t n = window.at(out.i0, j); n < window.at(out.i1, j); ++n)
          result[n] += w * next[n];
      });
      if (!first) std::swap(before, now);
      std::swap(now, next);
    }
    return result;
  }

  // What `out` of the image becomes, into `result`.
  void smooth(const TiledImage& relief, const TexelBox& out, TiledImage& result) const {
    const Window window(grown(out, reach(), *texels));
    std::vector<float> values(window.size());
    forTiles(window.box(), [&](const TexelBox& part) {
      if (const float* tile = relief.tile(tileOf(part)))
        for (int j = part.j0; j < part.j1; ++j)
          std::copy_n(tile + placeInTile(part.i0, j), width(part), &values[window.at(part.i0, j)]);
    });
    values = flow(std::move(values), window, out);
    forTiles(out, [&](const TexelBox& part) {
      const std::size_t index = tileOf(part);
      const float* source = relief.tile(index);
      const float* held = result.tile(index);
      float* own = nullptr;
      for (int j = part.j0; j < part.j1; ++j)
        for (int i = part.i0; i < part.i1; ++i) {
          const std::size_t at = placeInTile(i, j);
          float value = values[window.at(i, j)];
          if (std::abs(value) < kLeastValue) value = 0;
          if (texels->ownerAt(i, j) < 0) value = source ? source[at] : 0;
          const float old = held ? held[at] : 0.0F;
          if (std::bit_cast<std::uint32_t>(value) == std::bit_cast<std::uint32_t>(old)) continue;
          if (!own) held = own = result.writable(index);
          own[at] = value;
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
  made.most_rate = mostRate(*mesh, *uvs, *texels, deviation);
  for (const TexelMetric& metric : made.metrics)
    made.rate = std::max(made.rate, conductanceOf(metric, made.most_rate).rate());
  made.rate *= 1 + 1e-5; // rounding
  const double rho = made.rate * 0.5 * deviation * deviation;
  if (rho > 1e-6) made.weight = besselWeights(rho);
  made.mesh = std::move(mesh);
  made.uvs = std::move(uvs);
  made.links.resize(static_cast<std::size_t>(texels->width / kTileSide) *
                    static_cast<std::size_t>(texels->height / kTileSide));
  made.texels = std::move(texels);
}

ReliefSmoother::~ReliefSmoother() = default;

TiledImage ReliefSmoother::smoothed(const TiledImage& relief) const {
  const TiledImage none(relief.width(), relief.height(), 1);
  return resmoothed(none, none, relief);
}

TiledImage ReliefSmoother::resmoothed(const TiledImage& result, const TiledImage& before,
                                      const TiledImage& relief) const {
  const TexelMap& texels = *impl_->texels;
  for (const TiledImage* image : {&result, &before, &relief})
    if (image->width() != texels.width || image->height() != texels.height ||
        image->channels() != 1)
      throw std::invalid_argument("ReliefSmoother: not an image that the texel map was made for");
  if (impl_->weight.empty()) return relief;
  TiledImage made = result;
  const int reach = impl_->reach();
  for (const TexelBox& box : gathered(changedTexels(before, relief), 2 * reach, texels))
    impl_->smooth(relief, grown(box, reach, texels), made);
  return made;
}

const std::shared_ptr<const TexelMap>& ReliefSmoother::texels() const {
  return impl_->texels;
}

std::size_t ReliefSmoother::bytes() const {
  const std::lock_guard lock(impl_->mutex);
  const auto tiles = std::count_if(impl_->links.begin(), impl_->links.end(),
                                   [](const auto& tile) { return tile != nullptr; });
  return static_cast<std::size_t>(tiles) * sizeof(TileLinks) +
         impl_->metrics.size() * sizeof(TexelMetric) +
         impl_->texels->owner.size() * sizeof(impl_->texels->owner[0]);
}

} // namespace patina
