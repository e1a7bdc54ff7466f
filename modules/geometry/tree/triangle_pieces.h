// What a TriangleTree stores of its triangles: boxes to sort and frames to measure in. Positions
// are in the tree's own unit.
#pragma once

#include <vector>

#include "geometry/mesh/triangle_mesh.h"
#include "geometry/tree/wide_bvh.h"

namespace patina {

struct TrianglePieces {
  std::vector<BoxRef> boxes;                // permuted by the tree's builder
  std::vector<std::array<Vec3, 3>> corners; // of split faces' pieces: id - number of faces
  std::vector<std::int32_t> face;           // of those pieces
};

// One piece a face; faces much larger than most queries need are cut up, since a tight box and a
// short triangle are worth more than a small count, in speed and in float's digits.
TrianglePieces piecesOf(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

// The triangles of the nodes from `inner` on.
std::vector<TriangleBlock> triangleBlocks(const std::vector<WideNode>& nodes, std::int32_t inner,
                                          const std::vector<PacketTriangle>& triangles);

PacketTriangle packetTriangle(const Vec3& p, const Vec3& q, const Vec3& r, std::int32_t face);

} // namespace patina
