// Cells of one smoothing call and the conductances between them. Internal to the smoothing.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "authoring/relief/texel_rows.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// Texels grouped into cells, so that wide smoothing costs no more than narrow smoothing. Internal
// to the smoothing of relief.

// Half of the covariance added by diffusion for unit time [cells^2].
struct DiffusionTensor {
  float ii = 0, ij = 0, jj = 0;
};

// Diffusion through a cell: conductances to the neighbours along i, j and both diagonals, per unit
// area. The diagonals make the fourth-order error isotropic; none is negative unless a face is
// sheared by more than 45 degrees.
struct Conductance {
  float along_i = 0, along_j = 0, diagonal = 0, anti_diagonal = 0;

  Conductance() = default;
  explicit Conductance(const DiffusionTensor& tensor);
};
// Returns an upper bound of a cell's decay rate. For a mean it is at most the largest.
double maxDecayRate(const DiffusionTensor& tensor);

// The part of a square of texels that lies in one chart.
struct Cell {
  float area = 0; // [m^2]
  int texels = 0;
  Conductance conductance;                          // for all its area
  std::array<std::int16_t, 4> next{-1, -1, -1, -1}; // cell per CellDirection, -1 = none
  std::uint8_t plain = 0; // bit by CellDirection: both cells are the largest of their squares
};
enum CellDirection : std::size_t { kToEast, kToNorth, kToWest, kToSouth };

// Cells of one image tile: first the largest part of each square, i fastest, then the other parts.
struct CellTile {
  std::array<std::int16_t, kTileSide * kTileSide> cell_of{}; // cell of each texel, -1 = unused
  std::array<std::uint8_t, kTileSide * kTileSide> joined{};  // 1: to the east, 2: north
  std::vector<Cell> cells;
  std::vector<std::int16_t> square; // squares of the other parts
  bool linked = false;              // `next` is set
};

// Quadratic B-splines restrict values from texels to cells and prolong them back. Each direction
// adds a variance of exactly a quarter of a cell and reproduces straight lines.
class Spline {
 public:
  explicit Spline(int side);
  // Weights for the previous, own and next cell, by texel of a tile.
  const std::array<float, kTileSide>& operator[](std::size_t which) const { return weight_[which]; }

 private:
  std::array<std::array<float, kTileSide>, 3> weight_{};
};

// Makes cells tile by tile on demand.
class ReliefCells {
 public:
  // `side` [texels], a power of two up to kTileSide; `tensors` per face. Views, except `tensors`.
  ReliefCells(const TriangleMesh& mesh, const CornerUvs& uvs, const TexelMap& texels,
              const std::vector<TexelMetric>& metrics, std::vector<DiffusionTensor> tensors,
              int side);

  int side() const { return side_; }
  int squares() const { return kTileSide / side_; } // per side of a tile
  const Spline& spline() const { return spline_; }
  int across() const { return across_; } // tiles
  int along() const { return along_; }
  // Makes tiles [i0, i1) x [j0, j1), linked. Parallel; one caller at a time.
  void make(const TexelBox& tiles);
  const CellTile& tile(std::size_t index) const { return *tiles_[index]; }
  std::size_t bytes() const;

 private:
  std::unique_ptr<CellTile> made(std::size_t index) const;
  void link(std::size_t index);

  const TriangleMesh& mesh_;
  const CornerUvs& uvs_;
  const TexelMap& texels_;
  const std::vector<TexelMetric>& metrics_;
  std::vector<DiffusionTensor> tensors_;
  int side_, across_, along_;
  Spline spline_;
  std::vector<std::unique_ptr<CellTile>> tiles_;
};

inline int width(const TexelBox& box) {
  return box.i1 - box.i0;
}
TexelBox grown(const TexelBox& box, int by, const TexelBox& image);
TexelBox scaled(const TexelBox& box, int by);

// Calls visit(box) for the part in each tile of `side` texels or cells, row by row.
template <class Visit> void forTiles(const TexelBox& box, int side, const Visit& visit) {
  for (int j = box.j0 / side; j * side < box.j1; ++j)
    for (int i = box.i0 / side; i * side < box.i1; ++i) {
      const int x = i * side, y = j * side;
      visit(TexelBox{std::max(box.i0, x), std::max(box.j0, y), std::min(box.i1, x + side),
                     std::min(box.j1, y + side)});
    }
}

// Conductances from a cell to its neighbours at (1,0), (0,1), (1,1), (-1,1); per_area is 0 for
// unused cells.
enum Part : std::size_t { kEast, kNorth, kDiagonal, kAntiDiagonal, kPerArea, kParts };

// Values of cells: the largest cell of each square of a box with an empty border one cell wide;
// from grid() on the other cells of its tiles.
class ReliefWindow {
 public:
  // The cells must have been made.
  ReliefWindow(const ReliefCells& cells, const TexelBox& squares);

  const TexelBox& squares() const { return box_; }
  std::size_t stride() const { return stride_; }
  std::size_t grid() const { return grid_; }
  std::size_t size() const { return next_.size(); }
  std::size_t at(int i, int j) const { // square of the image
    return static_cast<std::size_t>(j - box_.j0 + 1) * stride_ +
           static_cast<std::size_t>(i - box_.i0 + 1);
  }

  // Links between the squares' largest cells, per value; and those of other cells.
  const std::array<std::vector<float>, kParts>& parts() const { return parts_; }
  struct Link {
    std::size_t a, b;
    float conductance;
  };
  const std::vector<Link>& links() const { return links_; }

  // Restricts an image to cells, and prolongs cells to the texels of a part of one tile. The
  // outermost squares lack the values beyond.
  std::vector<float> restrict(const TiledImage& image) const;
  using TileValues = std::array<float, kTileSide * kTileSide>;
  void prolong(const std::vector<float>& values, const TexelBox& part, TileValues& made) const;

 private:
  struct TilePart {
    std::size_t tile, others; // index of the first of its other cells
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
  std::vector<std::array<std::uint32_t, 4>> next_; // per CellDirection; the cell itself if none
  std::array<std::vector<float>, kParts> parts_;
  std::vector<Link> links_;
};

} // namespace patina
