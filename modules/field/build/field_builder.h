// A field while it is being made: its blocks may still be written.
#pragma once

#include <memory>
#include <vector>

#include "field/store/surface_field.h"

namespace patina {

// Stages of buildField: distances (unsigned) -> signs -> frozen().
struct FieldBuilder {
  // grid, band, blocks, top, block_at and coarse are filled; distance and face stay empty until
  // frozen(). top marks every block that is not stored kOutside until the signs are known.
  SurfaceField field;
  // Both by slot and in their small form from the start: a build holds no more than its field.
  // phi >= 0 in voxels (exact where <= band, kBeyondBand elsewhere) until signed.
  std::vector<std::shared_ptr<const DistanceBlock>> distance;
  // Faces of the mesh that the distances were taken from; -1 beyond the band.
  std::vector<std::shared_ptr<const FaceBlock>> face;
  // Coarse nodes, too, hold unsigned phi >= 0 and the gradient of the unsigned distance until
  // signed: a negative sign flips all four numbers. Nodes of padding blocks that reach past the
  // grid's last node are real points with real distances.
};

// All the distances of a block; of one node, which takes as long. Half a microsecond.
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

// The block with each of its faces f >= 0 replaced by `face_of(f)`.
template <typename FaceOf>
std::shared_ptr<const FaceBlock> renumbered(const FaceBlock& block, const FaceOf& face_of) {
  FaceNodes nodes;
  for (std::size_t n = 0; n < nodes.face.size(); ++n) {
    const std::int32_t face = block.at(n);
    nodes.face[n] = face < 0 ? face : face_of(face);
  }
  return std::make_shared<const FaceBlock>(nodes);
}

// Immutable from here on.
SurfaceField frozen(FieldBuilder&& builder);

} // namespace patina
