// From a point to the height of the texture under it, where no face's edge is near.
#pragma once

#include "scene/fourier/patch_table.h"
#include "scene/paint/face_table.h"

namespace patina {

struct TextureFoot {
  std::int32_t face;         // that the point is well over; -1: the walk has to tell
  float above;               // [m]
  const TexturePatch* patch; // null: no texture
};

// x, y, z: [m, world]; near_face: one of the table's, the point's own or one from which a few steps
// across edges lead to it, each time the edge that the point is farthest outside of. told: of a
// line becomes its height [m] and how that grows [m/m of its coordinate], else it stays.
using TextureLook = void (*)(const FaceTable& faces, const PatchTable& patches, double x, double y,
                             double z, std::int32_t near_face, TextureFoot& foot,
                             double* told) noexcept;
TextureLook textureLook() noexcept; // for this processor

} // namespace patina
