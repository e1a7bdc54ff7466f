// Points sorted by grid cells, to find those near each other or in a box. Internal to geometry.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/types.h"

namespace patina {

class PointGrid {
 public:
  // Takes finite points. A cell is at least `side` [m] wide, so that there are at most 2^20 along
  // an axis.
  PointGrid(const std::vector<Vec3>& points, double side);

  std::size_t size() const { return placed_.size(); }
  // Returns the original index of the n-th point in the grid's order. Values stored in the grid's
  // order lie side by side in memory for neighbours.
  std::size_t point(std::size_t n) const { return placed_[n].point; }

  // Calls visit(m), indices in the grid's order, for the points at most `reach` (no more than a
  // side) from the n-th, itself excluded. Its own row of cells comes first. Stops if visit returns
  // true. Looks at no more than 64 points per row, so that the time stays linear if many points
  // coincide. Any thread.
  template <class Visit> void forEachNear(std::size_t n, double reach, const Visit& visit) const {
    const std::uint64_t cell = placed_[n].cell;
    const std::size_t most = std::min(placed_.size(), n + 1 + kMaxMet / 2);
    for (std::size_t m = n + 1; m < most && placed_[m].cell <= cell + 1; ++m)
      if (isNear(n, m, reach) && visit(m)) return;
    if (visitBefore(n, reach, visit)) return;
    const std::uint64_t y = stride_[1], z = stride_[2];
    for (const std::uint64_t row : {y, z, z + y, z - y})
      if (visitRow(n, cell + row, reach, visit)) return;
  }

  // Calls visit(n, m), m < n, for the pairs that forEachNear() finds for n.
  template <class Visit> void forEachPair(double reach, const Visit& visit) const {
    for (std::size_t n = 0; n < placed_.size(); ++n)
      visitBefore(n, reach, [&](std::size_t m) {
        visit(n, m);
        return false;
      });
  }

  // Calls visit(n) for the points in the cells that a box touches, at most 64 per row of cells.
  template <class Visit> void forEachIn(const Box3& box, const Visit& visit) const {
    const Box3 within = box.intersection(box_);
    if (within.isEmpty()) return;
    const auto low = cellOf(within.min()), high = cellOf(within.max());
    for (std::uint64_t z = low[2]; z <= high[2]; z += stride_[2])
      for (std::uint64_t y = low[1]; y <= high[1]; y += stride_[1]) {
        const std::size_t begin = firstFrom(z + y + low[0]);
        const std::size_t end = std::min(placed_.size(), begin + kMaxMet);
        for (std::size_t i = begin; i < end && placed_[i].cell <= z + y + high[0]; ++i) visit(i);
      }
  }

 private:
  static constexpr std::size_t kMaxMet = 64;
  struct Placed {
    std::uint64_t cell;
    Vec3 at;
    std::uint32_t point;
  };

  bool isNear(std::size_t n, std::size_t m, double reach) const {
    return (placed_[m].at - placed_[n].at).squaredNorm() <= reach * reach;
  }
  // Visits the points of three cells of a row. Returns true once visit does.
  template <class Visit>
  bool visitRow(std::size_t n, std::uint64_t middle, double reach, const Visit& visit) const {
    const std::size_t begin = firstFrom(middle - 1);
    const std::size_t end = std::min(placed_.size(), begin + kMaxMet);
    for (std::size_t m = begin; m < end && placed_[m].cell <= middle + 1; ++m)
      if (isNear(n, m, reach) && visit(m)) return true;
    return false;
  }
  // Visits the points before the n-th, those of its own row first.
  template <class Visit> bool visitBefore(std::size_t n, double reach, const Visit& visit) const {
    const std::uint64_t cell = placed_[n].cell, y = stride_[1], z = stride_[2];
    const std::size_t least = n - std::min(n, kMaxMet / 2);
    for (std::size_t m = n; m > least && placed_[m - 1].cell + 1 >= cell; --m)
      if (isNear(n, m - 1, reach) && visit(m - 1)) return true;
    for (const std::uint64_t row : {y, z + y, z, z - y})
      if (visitRow(n, cell - row, reach, visit)) return true;
    return false;
  }

  // Returns the cell along each axis, as summands of its number.
  std::array<std::uint64_t, 3> cellOf(const Vec3& p) const {
    std::array<std::uint64_t, 3> cell{};
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      cell[axis] = stride_[axis] * (1 + static_cast<std::uint64_t>((p[k] - box_.min()[k]) / side_));
    }
    return cell;
  }

  // Returns the first point in the grid's order whose cell is `cell` or a later one.
  std::size_t firstFrom(std::uint64_t cell) const {
    const std::uint64_t part = cell >> shift_;
    if (part + 1 >= starts_.size()) return placed_.size();
    const auto begin = placed_.begin() + starts_[part], end = placed_.begin() + starts_[part + 1];
    const auto first = std::partition_point(
        begin, end, [cell](const Placed& placed) { return placed.cell < cell; });
    return static_cast<std::size_t>(first - placed_.begin());
  }

  Box3 box_;
  double side_ = 1;
  std::array<std::uint64_t, 3> stride_{1, 1, 1};
  std::vector<Placed> placed_;
  // For each value of a cell number's upper bits, the first point with it or a larger one.
  std::vector<std::uint32_t> starts_;
  int shift_ = 0;
};

} // namespace patina
