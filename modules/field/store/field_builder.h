// A field under construction, with writable blocks.
#pragma once

#include <memory>
#include <vector>

#include "field/store/surface_field.h"

namespace patina {

// Stages of buildField: distances (unsigned) -> signs -> finish().
struct FieldBuilder {
  // grid, band, blocks, block_index, block_at and coarse are filled; distance and face stay empty
  // until finish(). block_index holds kOutside for every unstored block until the signs are known.
  SurfaceField field;
  // Both by slot, in compact form, so that a build takes no more memory than its field. phi >= 0 in
  // voxels (exact where <= band, kBackground elsewhere) until signed.
  std::vector<std::shared_ptr<const DistanceBlock>> distance;
  // Nearest faces of the mesh; -1 beyond the band.
  std::vector<std::shared_ptr<const FaceBlock>> face;
  // Coarse nodes also hold unsigned phi >= 0 and the gradient of the unsigned distance until
  // signed: a negative sign flips all four numbers. Nodes of padding blocks beyond the grid's last
  // node have real distances.
};

// Returns all distances of a block; reading one takes as long, half a microsecond.
inline std::array<float, kBlockNodes> phiOf(const FieldBuilder& builder, std::size_t slot) {
  return builder.distance[slot]->phi();
}
inline float phiAt(const FieldBuilder& builder, std::int32_t slot, std::size_t node) {
  return builder.distance[static_cast<std::size_t>(slot)]->phi()[node];
}
inline void setPhi(FieldBuilder& builder, std::size_t slot,
                   const std::array<float, kBlockNodes>& phi) {
  builder.distance[slot] = std::make_shared<const DistanceBlock>(DistanceNodes{phi});
}

// Returns the block with each of its faces f >= 0 replaced by `face_of(f)`.
template <typename FaceOf>
std::shared_ptr<const FaceBlock> renumbered(const FaceBlock& block, const FaceOf& face_of) {
  FaceNodes nodes;
  for (std::size_t n = 0; n < nodes.face.size(); ++n) {
    const std::int32_t face = block.at(n);
    nodes.face[n] = face < 0 ? face : face_of(face);
  }
  return std::make_shared<const FaceBlock>(nodes);
}

// Returns the finished, immutable field.
SurfaceField finish(FieldBuilder&& builder);

} // namespace patina
