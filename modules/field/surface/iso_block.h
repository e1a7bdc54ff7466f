// What one block knows of the iso-surface: which of its nodes are inside, and the numbers of the
// vertices that lie on its own edges. Small, so that all blocks' can be kept while a mesh is put
// together.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "field/store/node_reader.h"
#include "field/surface/iso_cases.h"

namespace patina {

// phi of the block's nodes and the first layer of its upper neighbours, voxels, x fastest.
using CellPhi = std::array<float, kSampleSide * kSampleSide * kSampleSide>;

CellPhi gatherCells(const NodeReader& nodes, std::int32_t slot);

class IsoBlock {
 public:
  IsoBlock() = default;
  IsoBlock(const CellPhi& phi, float iso);

  bool empty() const { return triangles_ == 0 && vertices_ == 0; }
  int vertexCount() const { return vertices_; }
  int triangleCount() const { return triangles_; }
  // Whether the surface meets a cell that has a node beyond the band and is left out.
  bool skipsCells() const { return skips_cells_; }

  // Number of the vertex on the edge from own node (x, y, z), 0..7, along axis. It must exist.
  int vertex(int x, int y, int z, int axis) const {
    const auto row = static_cast<std::size_t>((axis * kBlockSide + z) * kBlockSide + y);
    return first_[row] + std::popcount(crossed_[row] & ((1U << x) - 1U));
  }

  // visit(x, y, z, axis) for each vertex on an own edge, in the order of their numbers.
  template <class Visit> void forVertices(const Visit& visit) const {
    for (int axis = 0, row = 0; axis < 3; ++axis)
      for (int z = 0; z < kBlockSide; ++z)
        for (int y = 0; y < kBlockSide; ++y, ++row)
          for (unsigned m = crossed_[static_cast<std::size_t>(row)]; m != 0; m &= m - 1)
            visit(std::countr_zero(m), y, z, axis);
  }

  // visit(x, y, z, pattern) for each complete cell that the surface meets.
  template <class Visit> void forCells(const Visit& visit) const {
    for (int z = 0; z < kBlockSide; ++z)
      for (int y = 0; y < kBlockSide; ++y) {
        const std::array<unsigned, 4> in = cellRows(inside_, y, z);
        for (unsigned m = meeting(in) & complete(y, z); m != 0; m &= m - 1) {
          const int x = std::countr_zero(m);
          unsigned pattern = 0;
          for (unsigned r = 0; r < 4; ++r) pattern |= (in[r] >> x & 3U) << 2 * r;
          visit(x, y, z, pattern);
        }
      }
  }

 private:
  // One bit a node along x, one row for each (y, z) of the 9 x 9.
  using Rows = std::array<std::uint16_t, kSampleSide * kSampleSide>;

  static std::array<unsigned, 4> cellRows(const Rows& rows, int y, int z) {
    const auto at = static_cast<std::size_t>(z * kSampleSide + y);
    return {rows[at], rows[at + 1], rows[at + kSampleSide], rows[at + kSampleSide + 1]};
  }
  // Cells of a row whose eight nodes are not all on one side.
  static unsigned meeting(const std::array<unsigned, 4>& in) {
    const unsigned any = in[0] | in[1] | in[2] | in[3], all = in[0] & in[1] & in[2] & in[3];
    return (any | any >> 1) & ~(all & all >> 1) & 0xFFU;
  }
  unsigned complete(int y, int z) const {
    const std::array<unsigned, 4> stored = cellRows(stored_, y, z);
    const unsigned all = stored[0] & stored[1] & stored[2] & stored[3];
    return all & all >> 1;
  }
  void numberVertices();
  void countTriangles();

  Rows inside_{}, stored_{};
  std::array<std::uint8_t, 3 * kBlockSide * kBlockSide> crossed_{}; // [axis][z][y], one bit each x
  std::array<std::uint16_t, 3 * kBlockSide * kBlockSide> first_{};  // number of the row's first
  int vertices_ = 0, triangles_ = 0;
  bool skips_cells_ = false;
};

} // namespace patina
