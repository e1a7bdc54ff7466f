// Occupancy of a square grid, a bit a cell, for packing shapes. Internal to the atlas.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace patina {

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

  // The lowest place, and the leftmost there, from row `first_row` on, no higher than last_top.
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
  std::vector<std::uint64_t> bits_; // cells that shapes or their gaps take
  std::vector<bool> row_used_;
};

} // namespace patina
