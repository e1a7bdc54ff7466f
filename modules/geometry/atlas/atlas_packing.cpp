#include "geometry/atlas/atlas_packing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include <tbb/parallel_for.h>

namespace patina {
namespace {

// Occupancy of a square grid, one bit a cell, for packing shapes.

// Cells [from, to) of a row.
struct CellRun {
  int row, from, to;
};

// A shape as runs with rows ascending from 0; its box is `width` x `height` cells.
struct CellShape {
  std::vector<CellRun> runs;
  int width = 0, height = 0;
};

struct CellPlace {
  int x = 0, y = 0;
};

class BitGrid {
 public:
  // Shapes stay `margin` cells away from the sides and more than `gap` cells from each other.
  BitGrid(int size, int margin, int gap);

  // Returns the lowest free position, and the leftmost in its row, from `first_row` to `last_top`.
  std::optional<CellPlace> place(const CellShape& shape, int first_row, int last_top) const;
  void add(const CellShape& shape, const CellPlace& at);
  int margin() const { return margin_; }
  int size() const { return size_; }

 private:
  std::uint64_t* row(int y) { return bits_.data() + static_cast<std::size_t>(y) * words_; }
  const std::uint64_t* row(int y) const {
    return bits_.data() + static_cast<std::size_t>(y) * words_;
  }

  int size_, margin_, gap_;
  std::size_t words_;
  std::vector<std::uint64_t> bits_; // cells that shapes or their gaps occupy
  std::vector<bool> row_used_;
};

constexpr std::uint64_t kAll = ~std::uint64_t{0};

// Computes to |= from >> shift: bit x of `to` gets bit x + shift.
void orShifted(std::uint64_t* to, const std::uint64_t* from, std::size_t words, int shift) {
  const std::size_t whole = static_cast<std::size_t>(shift) / 64;
  const int rest = shift % 64;
  for (std::size_t k = 0; k + whole < words; ++k) {
    std::uint64_t value = from[k + whole] >> rest;
    if (rest > 0 && k + whole + 1 < words) value |= from[k + whole + 1] << (64 - rest);
    to[k] |= value; // Reads never lie before the last write.
  }
}

void setBits(std::uint64_t* bits, int from, int to) {
  while (from < to) {
    const int end = std::min(to, (from / 64 + 1) * 64);
    const std::uint64_t mask = (end - from == 64 ? kAll : (std::uint64_t{1} << (end - from)) - 1);
    bits[from / 64] |= mask << (from % 64);
    from = end;
  }
}

BitGrid::BitGrid(int size, int margin, int gap)
    : size_(size), margin_(margin), gap_(gap), words_(static_cast<std::size_t>(size + 63) / 64),
      bits_(words_ * static_cast<std::size_t>(size), 0),
      row_used_(static_cast<std::size_t>(size), false) {}

std::optional<CellPlace> BitGrid::place(const CellShape& shape, int first_row, int last_top) const {
  const int columns = size_ - 2 * margin_ - shape.width + 1; // number of possible first columns
  if (columns <= 0) return std::nullopt;
  std::vector<std::uint64_t> never(words_, 0), blocked(words_), spread(words_);
  setBits(never.data(), 0, margin_);
  setBits(never.data(), margin_ + columns, static_cast<int>(words_) * 64);
  const int last = std::min(size_ - margin_, last_top) - shape.height;
  for (int y = std::max(first_row, margin_); y <= last; ++y) {
    blocked = never;
    bool full = false;
    for (const CellRun& run : shape.runs) {
      if (!row_used_[static_cast<std::size_t>(y + run.row)]) continue;
      const std::uint64_t* taken = row(y + run.row);
      std::copy(taken, taken + words_, spread.begin());
      const int length = run.to - run.from;
      int have = 1; // Bit x of spread is set if any of the cells x .. x + have - 1 is.
      for (; 2 * have <= length; have *= 2) orShifted(spread.data(), spread.data(), words_, have);
      if (have < length) orShifted(spread.data(), spread.data(), words_, length - have);
      orShifted(blocked.data(), spread.data(), words_, run.from);
      full = std::all_of(blocked.begin(), blocked.end(),
                         [](std::uint64_t word) { return word == kAll; });
      if (full) break;
    }
    if (full) continue;
    for (std::size_t k = 0; k < words_; ++k)
      for (int bit = 0; bit < 64 && blocked[k] != kAll; ++bit)
        if (!(blocked[k] >> bit & 1)) return CellPlace{static_cast<int>(k) * 64 + bit, y};
  }
  return std::nullopt;
}

void BitGrid::add(const CellShape& shape, const CellPlace& at) {
  for (const CellRun& run : shape.runs)
    for (int y = std::max(0, at.y + run.row - gap_);
         y <= std::min(size_ - 1, at.y + run.row + gap_); ++y) {
      setBits(row(y), std::max(0, at.x + run.from - gap_), std::min(size_, at.x + run.to + gap_));
      row_used_[static_cast<std::size_t>(y)] = true;
    }
}

constexpr std::size_t kCarefully = 400; // charts tried in all rotations from row 0

// Returns the convex hull, counter-clockwise.
std::vector<Vec2> hullOf(const ChartOutline& outline) {
  std::vector<Vec2> points;
  for (const auto& edge : outline.edges) points.push_back(edge[0]);
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return std::tie(a[0], a[1]) < std::tie(b[0], b[1]);
  });
  std::vector<Vec2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

// Returns the rotation with the smallest bounding box, one side of which lies along the hull.
Eigen::Rotation2Dd smallestBox(const std::vector<Vec2>& hull) {
  constexpr std::size_t kMaxTried = 90; // enough for a round hull
  Eigen::Rotation2Dd best(0);
  double least = std::numeric_limits<double>::infinity();
  const std::size_t stride = hull.size() / kMaxTried + 1;
  for (std::size_t k = 0; k < hull.size(); k += stride) {
    const Vec2 along = hull[(k + 1) % hull.size()] - hull[k];
    if (!(along.norm() > 0)) continue;
    const Eigen::Rotation2Dd turn(-std::atan2(along[1], along[0]));
    Eigen::AlignedBox2d box;
    for (const Vec2& p : hull) box.extend(turn * p);
    const double area = box.sizes().prod();
    if (area < least * (1 - 1e-9)) {
      least = area;
      best = turn;
    }
  }
  return best;
}

struct Turned {
  Eigen::Affine2d
      aligned_from_plane; // moves the corner of the smallest box to the origin, longer side along x
  Vec2 size;
};

Turned turned(const ChartOutline& outline) {
  const std::vector<Vec2> hull = hullOf(outline);
  Eigen::Rotation2Dd turn = smallestBox(hull);
  Eigen::AlignedBox2d box;
  for (const Vec2& p : hull) box.extend(turn * p);
  if (box.isEmpty()) box.extend(Vec2::Zero().eval());
  if (box.sizes()[1] > box.sizes()[0]) {
    turn = Eigen::Rotation2Dd(-std::numbers::pi / 2) * turn;
    box.setEmpty();
    for (const Vec2& p : hull) box.extend(turn * p);
  }
  Eigen::Affine2d aligned = Eigen::Translation2d(-box.min()) * Eigen::Affine2d(turn);
  return {aligned, box.sizes()};
}

// Cells that a chart touches.
struct Mask {
  int width, height;
  std::vector<std::uint8_t> cells;
  std::uint8_t& at(int x, int y) {
    return cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x)];
  }
};

// Marks the cells that the boundary crosses and those inside, which lie there as a whole.
Mask maskOf(const ChartOutline& outline, const Eigen::Affine2d& cells_from_plane,
            const Vec2& size) {
  Mask mask{static_cast<int>(size[0]) + 1, static_cast<int>(size[1]) + 1, {}};
  mask.cells.assign(static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height),
                    0);
  Mask flips = mask; // 1 = inside and outside change at this cell's centre
  const auto cell = [](double at, int count) {
    return std::clamp(static_cast<int>(std::floor(at)), 0, count - 1);
  };
  constexpr double kSlack = 1e-9;
  for (const auto& edge : outline.edges) {
    Vec2 a = cells_from_plane * edge[0], b = cells_from_plane * edge[1];
    if (a[1] > b[1]) std::swap(a, b);
    const double slope = b[1] > a[1] ? (b[0] - a[0]) / (b[1] - a[1]) : 0;
    const auto at = [&](double y) { return a[0] + (std::clamp(y, a[1], b[1]) - a[1]) * slope; };
    const int last = cell(b[1] + kSlack, mask.height);
    for (int row = cell(a[1] - kSlack, mask.height); row <= last; ++row) {
      double from = at(row), to = b[1] > a[1] ? at(row + 1) : b[0];
      if (from > to) std::swap(from, to);
      const int end = cell(to + kSlack, mask.width);
      for (int x = cell(from - kSlack, mask.width); x <= end; ++x) mask.at(x, row) = 1;
      const double middle = row + 0.5;
      if (!(a[1] <= middle && middle < b[1])) continue;
      const double first = std::ceil(at(middle) - 0.5);
      if (first < mask.width) flips.at(std::max(0, static_cast<int>(first)), row) ^= 1;
    }
  }
  for (int row = 0; row < mask.height; ++row) {
    std::uint8_t inside = 0;
    for (int x = 0; x < mask.width; ++x) mask.at(x, row) |= inside ^= flips.at(x, row);
  }
  return mask;
}

Mask quarterTurned(Mask& mask) {
  Mask result{mask.height, mask.width, std::vector<std::uint8_t>(mask.cells.size())};
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) result.at(mask.height - 1 - y, x) = mask.at(x, y);
  return result;
}

// Returns the point transform that belongs to quarterTurned().
Eigen::Affine2d quarterTurn(const Mask& mask) {
  Eigen::Affine2d turn;
  turn.matrix() << 0, -1, mask.height, 1, 0, 0, 0, 0, 1;
  return turn;
}

CellShape shapeOf(Mask& mask) {
  CellShape shape{{}, mask.width, mask.height};
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      if (!mask.at(x, y)) continue;
      const int from = x;
      while (x < mask.width && mask.at(x, y)) ++x;
      shape.runs.push_back({y, from, x});
    }
  return shape;
}

struct Problem {
  const std::vector<ChartOutline>& charts;
  std::vector<Turned> turned;
  std::vector<std::size_t> order;
  int image_size, gap, cells;
  double texelsPerCell() const { return static_cast<double>(image_size) / cells; }
};

// Returns an empty list if a chart does not fit.
std::vector<Eigen::Affine2d> placedAt(const Problem& problem, double scale) {
  const double unit = problem.texelsPerCell();
  BitGrid grid(problem.cells, static_cast<int>(std::ceil(problem.gap / 2 / unit)),
               static_cast<int>(std::ceil(problem.gap / unit)));
  std::vector<Eigen::Affine2d> result(problem.charts.size());
  int cursor = 0;
  for (std::size_t k = 0; k < problem.order.size(); ++k) {
    const std::size_t c = problem.order[k];
    const Turned& chart = problem.turned[c];
    Eigen::Affine2d cells_from_plane = Eigen::Scaling(scale / unit) * chart.aligned_from_plane;
    Mask mask = maskOf(problem.charts[c], cells_from_plane, chart.size * scale / unit);
    const bool carefully = k < kCarefully;
    std::optional<CellPlace> best;
    CellShape best_shape;
    int top = grid.size();
    for (int quarters = 0; quarters < (carefully ? 4 : 1); ++quarters) {
      if (quarters > 0) {
        cells_from_plane = quarterTurn(mask) * cells_from_plane;
        mask = quarterTurned(mask);
      }
      CellShape shape = shapeOf(mask);
      std::optional<CellPlace> place = grid.place(shape, carefully ? 0 : cursor, top);
      if (!place && !carefully) place = grid.place(shape, 0, top);
      if (!place) continue;
      best = place;
      top = place->y + shape.height - 1; // The next rotation must lie lower.
      best_shape = std::move(shape);
      result[c] = Eigen::Scaling(unit) * Eigen::Translation2d(best->x, best->y) * cells_from_plane;
    }
    if (!best) return {};
    grid.add(best_shape, *best);
    cursor = best->y;
  }
  return result;
}

double areaOf(const ChartOutline& outline) {
  double doubled = 0; // about a point of the chart
  for (const auto& edge : outline.edges)
    doubled += cross(edge[0] - outline.edges[0][0], edge[1] - outline.edges[0][0]);
  return doubled / 2;
}

} // namespace

std::size_t maxCharts(int image_size, int gap) {
  const double cells = std::min(image_size, 1024), unit = image_size / cells;
  const double slot = 1 + std::ceil(gap / unit);
  return static_cast<std::size_t>(std::max(1.0, 0.5 * (cells / slot) * (cells / slot)));
}

Packing packed(const std::vector<ChartOutline>& charts, int image_size, int gap) {
  const int max_cells = charts.size() <= 256 ? 256 : charts.size() <= 4096 ? 512 : 1024;
  Problem problem{charts,
                  std::vector<Turned>(charts.size()),
                  std::vector<std::size_t>(charts.size()),
                  image_size,
                  gap,
                  std::min(image_size, max_cells)};
  tbb::parallel_for(std::size_t{0}, charts.size(),
                    [&](std::size_t c) { problem.turned[c] = turned(charts[c]); });
  std::iota(problem.order.begin(), problem.order.end(), std::size_t{0});
  std::stable_sort(problem.order.begin(), problem.order.end(), [&](std::size_t a, std::size_t b) {
    return problem.turned[a].size[0] > problem.turned[b].size[0];
  });
  double sum = 0, longest = 0;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    sum += std::abs(areaOf(charts[c]));
    longest = std::max(longest, problem.turned[c].size[0]);
  }
  Packing result;
  if (!(longest > 0)) {
    result.texel_from_plane = placedAt(problem, 0);
    return result;
  }
  // Tries kTried scales at once, in descending order: the result does not depend on the threads.
  constexpr std::size_t kTried = 3;
  double low = 0, high = std::min(image_size / std::sqrt(sum), 1.5 * image_size / longest);
  for (int round = 0; round < 4; ++round) {
    std::array<std::vector<Eigen::Affine2d>, kTried> found;
    const auto scaleOf = [&](std::size_t k) {
      return low + (high - low) * static_cast<double>(k + 1) / (kTried + 1);
    };
    tbb::parallel_for(std::size_t{0}, kTried,
                      [&](std::size_t k) { found[k] = placedAt(problem, scaleOf(k)); });
    std::size_t best = kTried;
    for (std::size_t k = 0; k < kTried; ++k)
      if (!found[k].empty()) best = k;
    const double step = (high - low) / (kTried + 1);
    if (best == kTried) {
      high = low + step;
      continue;
    }
    low = scaleOf(best);
    high = low + step;
    result.scale = low;
    result.texel_from_plane = std::move(found[best]);
  }
  return result;
}

} // namespace patina
