#include "geometry/mesh/point_grid.h"

#include <bit>

namespace patina {
namespace {

struct Key {
  std::uint64_t cell;
  std::uint32_t point;
};

// Radix sort, 11 bits at a time from the lowest; points of one cell keep their order.
void sortByCell(std::vector<Key>& keys, int bits) {
  constexpr int kDigit = 11;
  std::vector<Key> other(keys.size());
  for (int low = 0; low < bits; low += kDigit) {
    std::array<std::uint32_t, (1 << kDigit) + 1> begin{};
    const auto digit = [&](const Key& key) { return (key.cell >> low) & ((1U << kDigit) - 1); };
    for (const Key& key : keys) ++begin[digit(key) + 1];
    for (std::size_t d = 1; d < begin.size(); ++d) begin[d] += begin[d - 1];
    for (const Key& key : keys) other[begin[digit(key)]++] = key;
    keys.swap(other);
  }
}

} // namespace

PointGrid::PointGrid(const std::vector<Vec3>& points, double side) {
  constexpr double kMaxCells = 1 << 20; // along an axis
  for (const Vec3& p : points) box_.extend(p);
  if (!points.empty()) side_ = std::max(side, box_.sizes().maxCoeff() / kMaxCells);
  if (!(side_ > 0)) side_ = 1; // all points coincide
  // Reserves an empty cell at both ends of a row, so that neighbours do not wrap.
  for (std::size_t k = 0; k < 2 && !points.empty(); ++k)
    stride_[k + 1] =
        stride_[k] * (static_cast<std::uint64_t>(box_.sizes()[static_cast<int>(k)] / side_) + 3);
  std::vector<Key> keys;
  keys.reserve(points.size());
  std::uint64_t last = 0;
  for (const Vec3& p : points) {
    const auto cell = cellOf(p);
    keys.push_back({cell[0] + cell[1] + cell[2], static_cast<std::uint32_t>(keys.size())});
    last = std::max(last, keys.back().cell);
  }
  const auto bits = static_cast<int>(std::bit_width(last));
  sortByCell(keys, bits);
  placed_.reserve(keys.size());
  for (const Key& key : keys) placed_.push_back({key.cell, points[key.point], key.point});
  shift_ = std::max(0, bits - static_cast<int>(std::bit_width(points.size())));
  starts_.reserve((last >> shift_) + 2);
  for (std::uint32_t i = 0; i < placed_.size(); ++i)
    while (starts_.size() <= placed_[i].cell >> shift_) starts_.push_back(i);
  starts_.push_back(static_cast<std::uint32_t>(placed_.size()));
}

} // namespace patina
