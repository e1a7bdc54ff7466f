#include "geometry/atlas/bit_grid.h"

#include <algorithm>

namespace patina {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};

// to |= from >> shift: bit x of `to` gets bit x + shift.
void orShifted(std::uint64_t* to, const std::uint64_t* from, std::size_t words, int shift) {
  const std::size_t whole = static_cast<std::size_t>(shift) / 64;
  const int rest = shift % 64;
  for (std::size_t k = 0; k + whole < words; ++k) {
    std::uint64_t value = from[k + whole] >> rest;
    if (rest > 0 && k + whole + 1 < words) value |= from[k + whole + 1] << (64 - rest);
    to[k] |= value; // reads lie at or after what has been written
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

} // namespace

BitGrid::BitGrid(int size, int margin, int gap)
    : size_(size), margin_(margin), gap_(gap), words_(static_cast<std::size_t>(size + 63) / 64),
      bits_(words_ * static_cast<std::size_t>(size), 0),
      row_used_(static_cast<std::size_t>(size), false) {}

std::optional<CellPlace> BitGrid::place(const CellShape& shape, int first_row, int last_top) const {
  const int columns = size_ - 2 * margin_ - shape.width + 1; // that can be the first
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
      int have = 1; // bit x of spread: any of the cells x .. x + have - 1
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

} // namespace patina
