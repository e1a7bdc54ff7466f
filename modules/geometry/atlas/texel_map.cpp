#include "geometry/atlas/texel_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include <tbb/parallel_for.h>

#include "geometry/tree/triangle_tree.h"

namespace patina {
namespace {

constexpr int kBandRows = 32; // one task a band; small enough that 512 rows feed several threads
constexpr double kBorder = kGutter;
constexpr double kMaxTexels = 1 << 20; // larger than any image; a bound for the exact comparison
using Corners = std::array<Vec2, 3>;   // [texels]

// Rounds to a grid of 2^-32 texels, on which products of differences compare exactly: each centre
// at a common edge belongs to exactly one of two faces, without a tolerance.
Corners inTexels(const Corners& uv, int width, int height) {
  constexpr double kGrid = 4294967296.0;
  Corners result;
  for (std::size_t k = 0; k < 3; ++k)
    result[k] = {std::round(uv[k][0] * width * kGrid) / kGrid,
                 std::round(uv[k][1] * height * kGrid) / kGrid};
  return result;
}

bool usable(const Corners& corners) {
  return std::all_of(corners.begin(), corners.end(), [](const Vec2& p) {
    return std::abs(p[0]) < kMaxTexels && std::abs(p[1]) < kMaxTexels; // false for NaN
  });
}

// Returns a1 a2 <= b1 b2, exactly for factors on the grid.
bool productAtMost(double a1, double a2, double b1, double b2) {
  const double a = a1 * a2, b = b1 * b2;
  const double difference = a - b;
  if (std::abs(difference) > 1e-14 * (std::abs(a) + std::abs(b))) return difference < 0;
  return difference + (std::fma(a1, a2, -a) - std::fma(b1, b2, -b)) <= 0;
}

// Returns the first texel of a row whose centre is on the edge or right of it; low.y <= y < high.y.
int firstFrom(const Vec2& low, const Vec2& high, double y) {
  const Vec2 along = high - low;
  const double x = low[0] + along[0] * ((y - low[1]) / along[1]) - 0.5;
  int i = static_cast<int>(std::ceil(x));
  if (std::abs(x - std::round(x)) > 1e-6) return i;
  const auto fromEdge = [&](int texel) {
    return productAtMost(along[0], y - low[1], along[1], texel + 0.5 - low[0]);
  };
  while (fromEdge(i - 1)) --i;
  while (!fromEdge(i)) ++i;
  return i;
}

struct Span {
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
};

// Returns the centres of row j in the face, whose lower and left edges are part of it.
Span coveredIn(const Corners& corners, int j) {
  const double y = j + 0.5;
  Span span;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 *low = &corners[k], *high = &corners[(k + 1) % 3];
    if ((*low)[1] > (*high)[1]) std::swap(low, high);
    if (!((*low)[1] <= y && y < (*high)[1])) continue;
    const int i = firstFrom(*low, *high, y);
    span.first = std::min(span.first, i);
    span.last = std::max(span.last, i);
  }
  return span;
}

// Returns the texels of row j that can be within the border of the face.
Span reachedIn(const Corners& corners, int j) {
  const double low = j + 0.5 - kBorder, high = j + 0.5 + kBorder;
  double from = std::numeric_limits<double>::infinity(), to = -from;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 &a = corners[k], &b = corners[(k + 1) % 3];
    const double bottom = std::min(a[1], b[1]), top = std::max(a[1], b[1]);
    if (top < low || bottom > high) continue;
    for (const double y : {std::max(low, bottom), std::min(high, top)}) {
      const double t = top > bottom ? (y - a[1]) / (b[1] - a[1]) : 0.0;
      const double x = a[0] + t * (b[0] - a[0]);
      from = std::min({from, x, top > bottom ? x : b[0]});
      to = std::max({to, x, top > bottom ? x : b[0]});
    }
  }
  if (!(from <= to)) return {};
  constexpr double kSlack = 1e-6;
  return {static_cast<int>(std::ceil(from - kBorder - 0.5 - kSlack)),
          static_cast<int>(std::floor(to + kBorder - 0.5 + kSlack)) + 1};
}

double squaredDistanceToBorder(const Corners& corners, const Vec2& p) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 *a = &corners[k], *b = &corners[(k + 1) % 3];
    // Starts at one end for both faces of an edge, so that their distances are equal bit for bit.
    if (std::tie((*b)[1], (*b)[0]) < std::tie((*a)[1], (*a)[0])) std::swap(a, b);
    const Vec2 edge = *b - *a;
    const double length2 = edge.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - *a).dot(edge) / length2, 0.0, 1.0) : 0.0;
    const Vec2 nearest = t < 1 ? Vec2(*a + t * edge) : *b;
    best = std::min(best, (p - nearest).squaredNorm());
  }
  return best;
}

// Faces that can own texels in each band of rows, ascending.
struct Bands {
  std::vector<std::size_t> offsets;
  std::vector<std::int32_t> faces;
};

Bands bandsOf(const CornerUvs& uvs, int width, int height) {
  const int count = (height + kBandRows - 1) / kBandRows;
  std::vector<std::array<std::int16_t, 2>> ranges(uvs.size());
  tbb::parallel_for(std::size_t{0}, uvs.size(), [&](std::size_t f) {
    const Corners corners = inTexels(uvs[f], width, height);
    ranges[f] = {0, -1};
    if (!usable(corners)) return;
    const auto [low, high] = std::minmax({corners[0][1], corners[1][1], corners[2][1]});
    if (high + kBorder < 0 || low - kBorder > height) return;
    const auto band = [&](double y) {
      return static_cast<std::int16_t>(
          std::clamp(static_cast<int>(std::floor(y / kBandRows)), 0, count - 1));
    };
    ranges[f] = {band(low - kBorder - 1), band(high + kBorder + 1)};
  });
  Bands bands;
  bands.offsets.assign(static_cast<std::size_t>(count) + 1, 0);
  for (const auto& range : ranges)
    for (int b = range[0]; b <= range[1]; ++b) ++bands.offsets[index(b) + 1];
  std::partial_sum(bands.offsets.begin(), bands.offsets.end(), bands.offsets.begin());
  bands.faces.resize(bands.offsets.back());
  std::vector<std::size_t> next(bands.offsets.begin(), bands.offsets.end() - 1);
  for (std::size_t f = 0; f < ranges.size(); ++f)
    for (int b = ranges[f][0]; b <= ranges[f][1]; ++b)
      bands.faces[next[index(b)]++] = static_cast<std::int32_t>(f);
  return bands;
}

class BandPainter {
 public:
  BandPainter(const CornerUvs& uvs, TexelMap& map, int first_row)
      : uvs_(uvs), map_(map), first_row_(first_row),
        last_row_(std::min(first_row + kBandRows, map.height)),
        distance2_(index(map.width) * index(last_row_ - first_row),
                   std::numeric_limits<float>::infinity()) {}

  // Must run for all faces of a band before any claims texels outside its area.
  void cover(std::int32_t face) {
    const Corners corners = inTexels(uvs_[index(face)], map_.width, map_.height);
    forRows(corners, 1, [&](int j) {
      const auto [first, last] = clipped(coveredIn(corners, j));
      std::int32_t* owner = map_.owner.data() + index(j) * index(map_.width);
      float* distance2 = distance2_.data() + index(j - first_row_) * index(map_.width);
      for (int i = first; i < last; ++i)
        if (owner[i] == kNone) {
          owner[i] = face;
          distance2[i] = -1;
        }
    });
  }

  void reachOut(std::int32_t face) {
    const Corners corners = inTexels(uvs_[index(face)], map_.width, map_.height);
    const double penalty = hasArea(uvs_[index(face)]) ? 0 : 4 * kBorder * kBorder;
    forRows(corners, kBorder + 1, [&](int j) {
      const auto [first, last] = clipped(reachedIn(corners, j));
      std::int32_t* owner = map_.owner.data() + index(j) * index(map_.width);
      float* best = distance2_.data() + index(j - first_row_) * index(map_.width);
      for (int i = first; i < last; ++i) {
        if (best[i] < 0) continue;
        const double distance2 = squaredDistanceToBorder(corners, {i + 0.5, j + 0.5});
        if (!(distance2 <= kBorder * kBorder)) continue;
        const auto rank = static_cast<float>(distance2 + penalty);
        if (!(rank < best[i])) continue;
        best[i] = rank;
        owner[i] = face;
      }
    });
  }

 private:
  Span clipped(const Span& span) const {
    return {std::max(span.first, 0), std::min(span.last, map_.width)};
  }
  template <class Visit> void forRows(const Corners& corners, double margin, Visit visit) const {
    const auto [low, high] = std::minmax({corners[0][1], corners[1][1], corners[2][1]});
    const int first = std::max(first_row_, static_cast<int>(std::floor(low - margin)));
    const int last = std::min(last_row_, static_cast<int>(std::ceil(high + margin)) + 1);
    for (int j = first; j < last; ++j) visit(j);
  }

  const CornerUvs& uvs_;
  TexelMap& map_;
  int first_row_, last_row_;
  std::vector<float> distance2_; // [texels squared]; -1 = covered
};

} // namespace

TexelMap texelMap(const CornerUvs& uvs, int width, int height) {
  if (width < 1 || height < 1 || width > 16384 || height > 16384)
    throw std::invalid_argument("an image has 1 to 16384 texels a side");
  TexelMap map{width, height, {}};
  map.owner.assign(index(width) * index(height), kNone);
  const Bands bands = bandsOf(uvs, width, height);
  tbb::parallel_for(std::size_t{0}, bands.offsets.size() - 1, [&](std::size_t b) {
    BandPainter painter(uvs, map, static_cast<int>(b) * kBandRows);
    const auto forFaces = [&](auto visit) {
      for (std::size_t k = bands.offsets[b]; k < bands.offsets[b + 1]; ++k) visit(bands.faces[k]);
    };
    forFaces([&](std::int32_t face) { painter.cover(face); });
    forFaces([&](std::int32_t face) { painter.reachOut(face); });
  });
  return map;
}

Vec3 texelBarycentric(const std::array<Vec2, 3>& uv, double u, double v) {
  if (!hasArea(uv)) return Vec3::Constant(1.0 / 3);
  const auto flat = [](const Vec2& p) { return Vec3(p[0], p[1], 0); };
  return closestBarycentric(Vec3(u, v, 0), flat(uv[0]), flat(uv[1]), flat(uv[2]));
}

TexelBox texelsNear(const std::array<Vec3, 3>& corners, const std::array<Vec2, 3>& uv,
                    const Vec3& centre, double radius, int width, int height) {
  Vec2 low = uv[0].cwiseMin(uv[1]).cwiseMin(uv[2]);
  Vec2 high = uv[0].cwiseMax(uv[1]).cwiseMax(uv[2]);
  const Vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const Vec3 normal = e1.cross(e2);
  const double area2 = normal.squaredNorm();
  const double longest2 = std::max(e1.squaredNorm(), e2.squaredNorm());
  if (area2 > 1e-20 * longest2 * longest2) {
    // u and v are linear on the face's plane, which cuts the sphere in a disc about `foot`.
    const Vec3 from_corner = centre - corners[0];
    const double offset2 = normal.dot(from_corner) * normal.dot(from_corner) / area2;
    // Rounding must not lose a face that the sphere just touches.
    const double disc2 = radius * radius * (1 + 1e-9) - offset2;
    if (disc2 < 0) return {};
    const Vec3 dual1 = e2.cross(normal) / area2, dual2 = normal.cross(e1) / area2;
    for (int k = 0; k < 2; ++k) {
      const double along1 = uv[1][k] - uv[0][k], along2 = uv[2][k] - uv[0][k];
      const Vec3 gradient = along1 * dual1 + along2 * dual2;
      const double middle = uv[0][k] + gradient.dot(from_corner);
      const double half = std::sqrt(disc2) * gradient.norm() * (1 + 1e-9);
      low[k] = std::max(low[k], middle - half);
      high[k] = std::min(high[k], middle + half);
    }
  }
  if (!(low[0] <= high[0] && low[1] <= high[1])) return {};
  const auto first = [](double at, int size) {
    return static_cast<int>(
        std::clamp(std::ceil(at * size - 0.5 - kBorder - 1e-6), 0.0, 1.0 * size));
  };
  const auto last = [](double at, int size) {
    return static_cast<int>(
        std::clamp(std::floor(at * size - 0.5 + kBorder + 1e-6) + 1, 0.0, 1.0 * size));
  };
  return {first(low[0], width), first(low[1], height), last(high[0], width), last(high[1], height)};
}

} // namespace patina
