// Texels gathered into cells, so that what is wide costs no more than what is narrow: private to
// the smoothing of relief.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "authoring/brush/texel_rows.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// Half of the covariance that a flow for the time 1 adds, in cells^2.
struct Spread {
  float ii = 0, ij = 0, jj = 0;
};

// Heat flow through a cell: conductances to the neighbours along i, j and both diagonals, for an
// area of 1. The diagonals have what makes the error of fourth order the same in all directions;
// none is negative, unless a face is sheared by more than 45 degrees.
struct Conductance {
  float along_i = 0, along_j = 0, rising = 0, falling = 0;

  Conductance() = default;
  explicit Conductance(const Spread& spread);
};
// At which a cell cools at most; of a mean no more than the greatest.
double mostRate(const Spread& spread);

// The part of a square of texels that one chart holds.
struct Cell {
  float area = 0; // [m^2]
  int texels = 0;
  Conductance conductance;                          // of all its area
  std::array<std::int16_t, 4> next{-1, -1, -1, -1}; // by Way; of the square there, -1 = none
  std::uint8_t plain = 0; // bit by Way: a square's largest cell, and so is the next one
};
enum Way : std::size_t { kToEast, kToNorth, kToWest, kToSouth };

// Of one tile of the image. The cells of its squares, the largest part of each, i fastest; after
// them the other parts.
struct CellTile {
  std::array<std::int16_t, kTileSide * kTileSide> cell_of{}; // by texel, -1 = shows nothing
  std::array<std::uint8_t, kTileSide * kTileSide> joined{};  // by texel: 1 to its east, 2 north
  std::vector<Cell> cells;
  std::vector<std::int16_t> square; // of the other parts
  bool linked = false;              // `next` is known
};

// Quadratic B-splines carry values from texels to cells and back: of each they add a variance of
// exactly a quarter of a cell, and reproduce straight lines.
class Spline {
 public:
  explicit Spline(int side);
  // For the cell before, the own and the next one; by texel of a tile.
  const std::array<float, kTileSide>& operator[](std::size_t which) const { return weight_[which]; }

 private:
  std::array<std::array<float, kTileSide>, 3> weight_{};
};

// Made tile by tile when it is asked for.
class ReliefCells {
 public:
  // `side` [texels], a power of two up to kTileSide; `spreads` by face. Views, all but `spreads`.
  ReliefCells(const TriangleMesh& mesh, const CornerUvs& uvs, const TexelMap& texels,
              const std::vector<TexelMetric>& metrics, std::vector<Spread> spreads, int side);

  int side() const { return side_; }
  int squares() const { return kTileSide / side_; } // of a tile, along a side
  const Spline& spline() const { return spline_; }
  int across() const { return across_; } // tiles
  int along() const { return along_; }
  // Tiles [i0, i1) x [j0, j1), linked. Parallel; one caller at a time.
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
  std::vector<Spread> spreads_;
  int side_, across_, along_;
  Spline spline_;
  std::vector<std::unique_ptr<CellTile>> tiles_;
};

} // namespace patina
