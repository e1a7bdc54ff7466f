// Finds the texture height under a point away from face edges.
#pragma once

#include <cstdint>

#include "field/store/four.h"
#include "scene/fourier/patch_table.h"

namespace patina {

// Faces for point location, as plain data for kernels of any instruction set (ReliefFaces).

// Barycentric coordinates and height above a face, affine from its first corner. One cache line per
// face; needs neither its other corners nor a division.
struct alignas(64) FaceFrame {
  // {w1, w2, above} by each axis; the last lanes hold the faces across the edges from corner 0, 1,
  // 2.
  Int4 lanes[3];
  float corner[4]; // relative to the middle; the last is 0
};

struct FaceTable {
  double middle[4]; // [m, world]; the last is 0
  const FaceFrame* frames;
};

inline constexpr float kInteriorMargin = 1e-3F; // barycentric margin
// Edges crossed before the exact walk takes over.
inline constexpr int kMaxCrossed = 4;

struct TextureHit {
  std::int32_t face;         // face well below the point; -1: use the exact walk
  float above;               // [m]
  const TexturePatch* patch; // null: no texture
};

// x, y, z: [m, world]; near_face: a face of the table at most a few steps from the point's own,
// each across the edge that the point is farthest outside of. result: receives height [m] and
// derivative [m/m of the coordinate] of a line, otherwise unchanged.
using TextureKernel = void (*)(const FaceTable& faces, const PatchTable& patches, double x,
                               double y, double z, std::int32_t near_face, TextureHit& foot,
                               double* result) noexcept;
TextureKernel textureKernel() noexcept; // kernel for this processor

} // namespace patina
