// Points sorted by the cells of a grid, to find those near each other or within a box. Internal to
// open_parts and mesh_report.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/types.h"

namespace patina {

class PointGrid {
 public:
  // The points are finite. A cell is as wide as `side` [m], or wider, so that there are at most
  // 2^20 along an axis.
  PointGrid(const std::vector<Vec3>& points, double side);

  std::size_t size() const { return placed_.size(); }
  // The n-th point in the grid's order has this index among the given ones. A caller that keeps
  // values of points in the grid's order has those of neighbours side by side in memory.
  std::size_t point(std::size_t n) const { return placed_[n].point; }

  // Calls visit(m), numbers in the grid's order, for the points that are at most `reach` from the
  // n-th, a side or less, itself left out. Those of its own row of cells come first, and nothing
  // more once visit returns true. Of a row 64 points are looked at, so that the time stays linear
  // where many points are in one place. From any number of threads.
  template <class Visit> void forEachNear(std::size_t n, double reach, const Visit& visit) const {
    const Vec3 at = placed_[n].at;
    const std::uint64_t cell = placed_[n].cell;
    const double square = reach * reach;
    const auto isLast = [&](std::size_t m) {
      return (placed_[m].at - at).squaredNorm() <= square && visit(m);
    };
    const std::size_t least = n - std::min(n, kMostMet / 2),
                      most = std::min(placed_.size(), n + 1 + kMostMet / 2);
    for (std::size_t m = n + 1; m < most && placed_[m].cell <= cell + 1; ++m)
      if (isLast(m)) return;
    for (std::size_t m = n; m > least && placed_[m - 1].cell + 1 >= cell; --m)
      if (isLast(m - 1)) return;
    for (const std::uint64_t z : {std::uint64_t{0}, stride_[2], 0 - stride_[2]})
      for (const std::uint64_t y : {std::uint64_t{0}, stride_[1], 0 - stride_[1]}) {
        if (z == 0 && y == 0) continue;
        const std::uint64_t middle = cell + z + y;
        const std::size_t begin = firstFrom(middle - 1);
        const std::size_t end = std::min(placed_.size(), begin + kMostMet);
        for (std::size_t m = begin; m < end && placed_[m].cell <= middle + 1; ++m)
          if (isLast(m)) return;
      }
  }

  // Calls visit(n) for each point in the cells that a box touches, of a row of cells the first 64.
  template <class Visit> void forEachIn(const Box3& box, const Visit& visit) const {
    const Box3 within = box.intersection(box_);
    if (within.isEmpty()) return;
    const auto low = cellOf(within.min()), high = cellOf(within.max());
    for (std::uint64_t z = low[2]; z <= high[2]; z += stride_[2])
      for (std::uint64_t y = low[1]; y <= high[1]; y += stride_[1]) {
        const std::size_t begin = firstFrom(z + y + low[0]);
        const std::size_t end = std::min(placed_.size(), begin + kMostMet);
        for (std::size_t i = begin; i < end && placed_[i].cell <= z + y + high[0]; ++i) visit(i);
      }
  }

 private:
  static constexpr std::size_t kMostMet = 64;
  struct Placed {
    std::uint64_t cell;
    Vec3 at;
    std::uint32_t point;
  };

  // Along each axis, as parts of a cell's number.
  std::array<std::uint64_t, 3> cellOf(const Vec3& p) const {
    std::array<std::uint64_t, 3> cell{};
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      cell[axis] = stride_[axis] * (1 + static_cast<std::uint64_t>((p[k] - box_.min()[k]) / side_));
    }
    return cell;
  }

  // The first point in the grid's order whose cell is `cell` or a later one.
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
  // The index holds, for the upper bits of a cell's number, the first point there or later.
  std::vector<std::uint32_t> starts_;
  int shift_ = 0;
};

} // namespace patina
