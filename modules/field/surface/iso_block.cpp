#include "field/surface/iso_block.h"

#include <algorithm>
#include <cmath>

namespace patina {

CellPhi gatherCells(const NodeReader& nodes, std::int32_t slot) {
  const SurfaceField& field = nodes.field();
  CellPhi cells;
  const std::array<int, 3>& at = field.block_at[static_cast<std::size_t>(slot)];
  for (int dz = 0; dz < 2; ++dz)
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx) {
        const int bx = at[0] + dx, by = at[1] + dy, bz = at[2] + dz;
        const bool in_table = bx < field.blocks[0] && by < field.blocks[1] && bz < field.blocks[2];
        const std::int32_t from = in_table ? field.slotOf(bx, by, bz) : SurfaceField::kOutside;
        const float* phi =
            from >= 0 ? nodes.block(static_cast<std::size_t>(from)).phi.data() : nullptr;
        const int nx = dx ? 1 : kBlockSide, ny = dy ? 1 : kBlockSide, nz = dz ? 1 : kBlockSide;
        for (int z = 0; z < nz; ++z)
          for (int y = 0; y < ny; ++y) {
            float* row = &cells[static_cast<std::size_t>(
                ((dz * kBlockSide + z) * kSampleSide + dy * kBlockSide + y) * kSampleSide +
                dx * kBlockSide)];
            if (phi)
              std::copy_n(phi + (z * kBlockSide + y) * kBlockSide, nx, row);
            else
              std::fill_n(row, nx, phiBeyond(from));
          }
      }
  return cells;
}

IsoBlock::IsoBlock(const CellPhi& phi, float iso) {
  const float* value = phi.data();
  unsigned any = 0, all = ~0U;
  for (std::size_t row = 0; row < inside_.size(); ++row, value += kSampleSide) {
    unsigned inside = 0, stored = 0;
    for (int x = 0; x < kSampleSide; ++x) {
      inside |= static_cast<unsigned>(value[x] < iso) << x;
      stored |= static_cast<unsigned>(std::abs(value[x]) < kBeyondBand) << x;
    }
    inside_[row] = static_cast<std::uint16_t>(inside);
    stored_[row] = static_cast<std::uint16_t>(stored);
    any |= inside;
    all &= inside;
  }
  if (any == 0 || (all & 0x1FFU) == 0x1FFU) return;
  numberVertices();
  countTriangles();
}

void IsoBlock::numberVertices() {
  std::size_t row = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int z = 0; z < kBlockSide; ++z)
      for (int y = 0; y < kBlockSide; ++y, ++row) {
        const auto at = static_cast<std::size_t>(z * kSampleSide + y);
        const std::size_t next = at + (axis == 1 ? 1 : axis == 2 ? kSampleSide : 0);
        const unsigned shift = axis == 0 ? 1 : 0;
        const unsigned change = inside_[at] ^ static_cast<unsigned>(inside_[next] >> shift);
        const unsigned stored = stored_[at] & static_cast<unsigned>(stored_[next] >> shift);
        crossed_[row] = static_cast<std::uint8_t>(change & stored & 0xFFU);
        first_[row] = static_cast<std::uint16_t>(vertices_);
        vertices_ += std::popcount(crossed_[row]);
      }
}

void IsoBlock::countTriangles() {
  const auto& cases = isoCases();
  forCells([&](int, int, int, unsigned pattern) { triangles_ += cases[pattern].count; });
  for (int z = 0; z < kBlockSide; ++z)
    for (int y = 0; y < kBlockSide; ++y)
      skips_cells_ |= (meeting(cellRows(inside_, y, z)) & ~complete(y, z)) != 0;
}

} // namespace patina
