// Faces to find a point's own among, plain enough for a kernel of any instruction set
// (ReliefFaces).
#pragma once

#include <cstdint>

#include "field/sampling/four.h"

namespace patina {

// Over a face: its barycentric coordinates and the height above it, affine from its first corner
// on. A cache line a face: no corner is unpacked, nothing divided.
struct alignas(64) FaceFrame {
  // {w1, w2, above} by each axis; in the last lanes the faces across the edges from corner 0, 1, 2.
  Int4 lanes[3];
  float corner[4]; // about the middle; the last is 0
};

struct FaceTable {
  double middle[4]; // [m, world]; the last is 0
  const FaceFrame* frames;
};

inline constexpr float kWellWithin = 1e-3F; // of a barycentric coordinate
// Edges, before a walk begins that unpacks corners and divides.
inline constexpr int kMostCrossed = 4;

} // namespace patina
