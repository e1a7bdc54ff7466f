// Which points are near each other. Internal to open_parts.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/types.h"

namespace patina {

// Points in the cells of a grid, sorted; a cell meets its neighbours in rows of three.
class NearPoints {
 public:
  NearPoints(const std::vector<Vec3>& points, double reach) : reach_(reach) {
    constexpr double kMostCells = 1 << 20; // along a side
    Box3 box;
    for (const Vec3& p : points) box.extend(p);
    const double side = points.empty() ? 1 : std::max(reach, box.sizes().maxCoeff() / kMostCells);
    // An empty cell between rows, so that neighbours do not wrap.
    for (std::size_t k = 0; k < 2 && !points.empty(); ++k)
      stride_[k + 1] =
          stride_[k] * (static_cast<std::uint64_t>(box.sizes()[static_cast<int>(k)] / side) + 3);
    struct Key {
      std::uint64_t cell;
      std::uint32_t point;
      auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    keys.reserve(points.size());
    for (const Vec3& p : points) {
      const Vec3 at = (p - box.min()) / side;
      std::uint64_t cell = stride_[0] + stride_[1] + stride_[2];
      for (int k = 0; k < 3; ++k)
        cell += stride_[static_cast<std::size_t>(k)] * static_cast<std::uint64_t>(at[k]);
      keys.push_back({cell, static_cast<std::uint32_t>(keys.size())});
    }
    std::sort(keys.begin(), keys.end());
    placed_.reserve(keys.size());
    for (const Key& key : keys) placed_.push_back({key.cell, points[key.point], key.point});
  }

  // visit(i, j) for pairs at most `reach` apart; once it returns true, i meets no more points of
  // that row. Of each row a point meets 64 at most, so that crowds take no longer.
  template <class Visit> void forPairs(const Visit& visit) const {
    const std::array<std::uint64_t, 4> ahead{stride_[1], stride_[2] - stride_[1], stride_[2],
                                             stride_[2] + stride_[1]};
    std::array<std::size_t, 4> first{};
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      const std::uint64_t cell = placed_[i].cell;
      meet(i, i + 1, cell + 1, visit);
      for (std::size_t row = 0; row < ahead.size(); ++row) {
        const std::uint64_t middle = cell + ahead[row];
        std::size_t& begin = first[row];
        while (begin < placed_.size() && placed_[begin].cell + 1 < middle) ++begin;
        meet(i, begin, middle + 1, visit);
      }
    }
  }

 private:
  struct Placed {
    std::uint64_t cell;
    Vec3 at;
    std::uint32_t point;
  };

  template <class Visit>
  void meet(std::size_t i, std::size_t from, std::uint64_t last_cell, const Visit& visit) const {
    constexpr std::size_t kMostMet = 64;
    const std::size_t end = std::min(placed_.size(), from + kMostMet);
    for (std::size_t j = from; j < end && placed_[j].cell <= last_cell; ++j)
      if ((placed_[j].at - placed_[i].at).squaredNorm() <= reach_ * reach_ &&
          visit(placed_[i].point, placed_[j].point))
        return;
  }

  const double reach_;
  std::array<std::uint64_t, 3> stride_{1, 1, 1};
  std::vector<Placed> placed_;
};

} // namespace patina
