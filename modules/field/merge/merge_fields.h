// Merges several objects' fields into one by the minimum (K14).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "field/store/field_grid.h"
#include "field/store/node_reader.h"

namespace patina {

// Lattice on which the blocks of all objects' fields coincide, so that they merge without
// resampling (K14).

// Unbounded lattice: node (0, 0, 0) at the anchor; block (b) holds the nodes 8 b .. 8 b + 7.
struct BlockLattice {
  Vec3 anchor = Vec3::Zero(); // [m]
  double voxel = 0;           // [m]
};

// Blocks low <= b < high.
struct BlockBox {
  std::array<int, 3> low{}, high{};

  bool isEmpty() const { return high[0] <= low[0]; }
  bool contains(const std::array<int, 3>& b) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (b[a] < low[a] || b[a] >= high[a]) return false;
    return true;
  }
  void extend(const BlockBox& other);
};

// Returns the fewest blocks whose nodes extend `band` voxels beyond the box. Throws Error if they
// exceed the size of a grid.
BlockBox blocksAround(const BlockLattice& lattice, const Box3& box, double band);

// Returns the grid of these blocks. Throws Error beyond 4096 nodes a side.
FieldGrid gridOf(const BlockLattice& lattice, const BlockBox& blocks);

// Returns the lowest block of a grid on the lattice.
std::array<int, 3> firstBlock(const BlockLattice& lattice, const FieldGrid& grid);

struct SheetCaps;

// One object's field on the lattice, unchanged while other objects change. Its grid extends at
// least the band beyond its surface.
struct FieldPart {
  std::shared_ptr<const SurfaceField> field; // samples are not required
  std::array<int, 3> first_block{};          // lattice position of its block (0, 0, 0)
  std::int32_t first_face = 0;               // first face in the combined mesh; ascends
  std::shared_ptr<const SheetCaps> caps{};   // caps of its sheets, for redistanced()

  BlockBox blocks() const;
};

// Computes phi = min over the parts. Where objects do not overlap, a node's value, and so a force,
// equals that of its object alone bit for bit. Outside the union the distance is exact; inside,
// |phi| is a lower bound of the depth, as the nearest point of a part may lie inside another (F9;
// see redistance.h). A node has the face of the part with the least phi, the first one in a tie.
// Blocks of a single part are shared with it. Reading takes the same time for any number of parts.
// Coarse nodes outside every part's grid have lower bounds and a zero gradient.
//
// Makes no sample layer. Parallel. Throws invalid_argument without parts or if voxels or bands
// differ, and Error if the parts are too far apart for one grid.
SurfaceField mergeFields(std::span<const FieldPart> parts, const BlockLattice& lattice);

// Returns phi [voxel] of one part at a point in grid coordinates of the lattice; `nodes` reads the
// part's field. Trilinear in the band, beyond it a bound of the right sign that is closer to zero.
// Not for the servo.
double phiOfPart(const FieldPart& part, const NodeReader& nodes, const Vec3& q);

} // namespace patina
