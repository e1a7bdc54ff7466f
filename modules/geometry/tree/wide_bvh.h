// Bounding volumes, eight children a node, over boxes in the tree's own unit.
#pragma once

#include <vector>

#include "geometry/tree/triangle_packet.h"

namespace patina {

// Two rows of four, for the builder's arithmetic. The fourth column holds the id in two exact
// floats, since an integer's bits would be a denormal number, which is slow.
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

// Splits by the surface-area rule with binned centroids. Permutes refs: a leaf child ~i is refs[i].
// refs must not be empty. No path is longer than kMaxTreeDepth nodes.
std::vector<WideNode> buildWideBvh(std::vector<BoxRef>& refs);

inline constexpr int kMaxTreeDepth = 88;

// Puts the nodes that hold triangles alone behind the others, and says how many others there are.
// Parents stay ahead of their children. A point's search leaves what is behind unread.
std::int32_t moveLeavesBehind(std::vector<WideNode>& nodes);

// Fits the children's cylinders, given the triangles in the order of refs.
void fitCylinders(std::vector<WideNode>& nodes, const std::vector<PacketTriangle>& triangles);

} // namespace patina
