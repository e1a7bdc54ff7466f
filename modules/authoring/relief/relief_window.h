// The cells that one call of the smoothing works on, and how heat flows between them: private to
// it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "authoring/relief/relief_cells.h"

namespace patina {

inline int width(const TexelBox& box) {
  return box.i1 - box.i0;
}
TexelBox grown(const TexelBox& box, int by, const TexelBox& image);
TexelBox scaled(const TexelBox& box, int by);

// visit(box) of the part in each tile of `side` texels or cells, row by row.
template <class Visit> void forTiles(const TexelBox& box, int side, const Visit& visit) {
  for (int j = box.j0 / side; j * side < box.j1; ++j)
    for (int i = box.i0 / side; i * side < box.i1; ++i) {
      const int x = i * side, y = j * side;
      visit(TexelBox{std::max(box.i0, x), std::max(box.j0, y), std::min(box.i1, x + side),
                     std::min(box.j1, y + side)});
    }
}

// Conductances from a cell to its neighbours at (1,0), (0,1), (1,1), (-1,1); per_area is 0 where
// nothing is shown.
enum Part : std::size_t { kEast, kNorth, kRising, kFalling, kPerArea, kParts };

// Places of values: the largest cell of each square of a box, with a border of nothing a cell wide;
// from grid() on the other cells of its tiles.
class ReliefWindow {
 public:
  // Of cells that are made.
  ReliefWindow(const ReliefCells& cells, const TexelBox& squares);

  const TexelBox& squares() const { return box_; }
  std::size_t stride() const { return stride_; }
  std::size_t grid() const { return grid_; }
  std::size_t size() const { return next_.size(); }
  std::size_t at(int i, int j) const { // squares of the image
    return static_cast<std::size_t>(j - box_.j0 + 1) * stride_ +
           static_cast<std::size_t>(i - box_.i0 + 1);
  }

  // Between squares' largest cells, by place; and what other cells have part in.
  const std::array<std::vector<float>, kParts>& parts() const { return parts_; }
  struct Link {
    std::size_t a, b;
    float conductance;
  };
  const std::vector<Link>& links() const { return links_; }

  // Values of an image to cells, and to the texels of a part of one tile. The outermost squares'
  // lack what is beyond.
  std::vector<float> gathered(const TiledImage& image) const;
  using TileValues = std::array<float, kTileSide * kTileSide>;
  void spread(const std::vector<float>& values, const TexelBox& part, TileValues& made) const;

 private:
  struct TilePart {
    std::size_t tile, others; // place of its first cell that is no square's largest
    TexelBox squares;
  };
  std::size_t placeOf(const TilePart& part, std::size_t cell) const;
  bool isIn(const TilePart& part, std::size_t cell) const;
  template <class Visit> void forCells(const TilePart& part, const Visit& visit) const;
  void readNext(const TilePart& part, std::vector<Conductance>& conductances);
  void join(const TilePart& part, const std::vector<Conductance>& conductances,
            std::vector<Link>& links);
  std::array<std::size_t, 9> about(std::size_t place) const;
  struct Moments;
  void takeMoments(const TilePart& part, const TiledImage& image,
                   std::vector<Moments>& moments) const;

  const ReliefCells& cells_;
  TexelBox box_, tile_box_;
  std::size_t stride_, grid_;
  std::vector<TilePart> tiles_;
  std::vector<std::array<std::uint32_t, 4>> next_; // by Way; itself where there is none
  std::array<std::vector<float>, kParts> parts_;
  std::vector<Link> links_;
};

} // namespace patina
