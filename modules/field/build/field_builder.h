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
  // By slot. phi >= 0 in voxels (exact where <= band, kBeyondBand elsewhere) until signed.
  std::vector<std::unique_ptr<DistanceNodes>> distance;
  // By slot. Faces of the mesh that the distances were taken from; -1 beyond the band.
  std::vector<std::unique_ptr<FaceNodes>> face;
  // Coarse nodes, too, hold unsigned phi >= 0 and the gradient of the unsigned distance until
  // signed: a negative sign flips all four numbers. Nodes of padding blocks that reach past the
  // grid's last node are real points with real distances.
};

// Immutable from here on; the blocks take their small form. Parallel.
SurfaceField frozen(FieldBuilder&& builder);

} // namespace patina
