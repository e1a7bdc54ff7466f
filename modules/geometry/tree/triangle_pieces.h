// Boxes, frames and bounding volume hierarchy of a TriangleTree's triangles, in its own unit.
#pragma once

#include <vector>

#include "geometry/mesh/triangle_mesh.h"
#include "geometry/tree/triangle_packet.h"

namespace patina {

// Bounding volume hierarchy with eight children per node, over boxes in the tree's own unit.

// Two rows of four floats. The fourth column holds the id as two exact floats, since an integer's
// bits would be a denormal number, which is slow.
struct alignas(16) BoxRef {
  float lo[3], id_low;
  float hi[3], id_high;

  void setId(std::int32_t id) {
    id_low = static_cast<float>(id & 0xfff);
    id_high = static_cast<float>(id >> 12);
  }
  std::int32_t id() const {
    return static_cast<std::int32_t>(id_low) + (static_cast<std::int32_t>(id_high) << 12);
  }
};

// Splits by the surface-area heuristic with binned centroids. Permutes refs: a leaf child ~i is
// refs[i]. refs must not be empty. No path is longer than kMaxTreeDepth nodes.
std::vector<WideNode> buildWideBvh(std::vector<BoxRef>& refs);

inline constexpr int kMaxTreeDepth = 88;

// Moves the nodes that hold only triangles to the end and returns the number of the others. Parents
// stay before their children. The search for one point does not read the moved nodes.
std::int32_t partitionLeavesLast(std::vector<WideNode>& nodes);

// Fits the children's cylinders to the triangles, given in the order of refs.
void fitCylinders(std::vector<WideNode>& nodes, const std::vector<PacketTriangle>& triangles);

// A face with the three corners of another one, in any order.
struct CopiedFace {
  std::int32_t first = 0, copy = 0; // `first` is the lowest of all
  auto operator<=>(const CopiedFace&) const = default;
};

// Returns the copies of faces that occur more than 32 times, ascending. Every search near them
// would look at all of them, since no box tells them apart.
std::vector<CopiedFace> findManyCopies(const std::vector<Vec3>& positions,
                                       const std::vector<Triangle>& triangles);

struct TrianglePieces {
  std::vector<BoxRef> boxes;                // permuted by the tree's builder
  std::vector<std::array<Vec3, 3>> corners; // pieces of split faces: id - number of faces
  std::vector<std::int32_t> face;           // face of each of those pieces
};

// Makes one piece per face, but none of copies. Faces much larger than most queries are split:
// tighter boxes and shorter triangles are faster and more exact in float than fewer pieces.
TrianglePieces piecesOf(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                        const std::vector<CopiedFace>& copies = {});

// Returns the triangles of the nodes from `first_leaf_node` on.
std::vector<TriangleBlock> triangleBlocks(const std::vector<WideNode>& nodes,
                                          std::int32_t first_leaf_node,
                                          const std::vector<PacketTriangle>& triangles);

PacketTriangle packetTriangle(const Vec3& p, const Vec3& q, const Vec3& r, std::int32_t face);

} // namespace patina
