// Several objects' fields as one, by min (K14).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "field/store/block_lattice.h"
#include "field/store/node_reader.h"

namespace patina {

struct PlateCaps;

// One object's field on the lattice; kept while the object is, whatever becomes of the others. Its
// grid reaches at least the band past its surface.
struct FieldPart {
  std::shared_ptr<const SurfaceField> field; // need not have samples
  std::array<int, 3> first_block{};          // where its block (0, 0, 0) lies on the lattice
  std::int32_t first_face = 0;               // of its mesh in the joint mesh; ascends
  std::shared_ptr<const PlateCaps> caps{};   // of its plates (BuiltField); read by redistanced()

  BlockBox blocks() const;
};

// phi = min over the parts. Where nobody overlaps anybody a node's value, and with it a force, is
// bit for bit that of its object alone. Outside the union the distance is exact; inside, |phi| is
// at most the depth, and less where the nearest point of the part lies inside another (F9; see
// redistance.h). A node's face is that of the part with the least phi, of the first such part in a
// tie. Blocks that only one part holds are shared with it. Reading costs the same for any number of
// parts. Coarse nodes outside every part's grid hold lower bounds with a zero gradient.
//
// No sample layer. Parallel. Throws invalid_argument without parts or if voxels or bands differ;
// Error if the parts are too far apart for one grid.
SurfaceField mergeFields(std::span<const FieldPart> parts, const BlockLattice& lattice);

// phi [voxel] of one part, whose field's nodes are given, at a point in grid coordinates of the
// lattice: trilinear in the band, beyond it a bound of the right sign that is nearer to zero. Not
// for the servo.
double phiOfPart(const FieldPart& part, const NodeReader& nodes, const Vec3& q);

} // namespace patina
