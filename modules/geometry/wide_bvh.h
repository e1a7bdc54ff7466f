// Bounding volumes, eight children a node, over boxes in the tree's own unit.
#pragma once

#include <vector>

#include "geometry/triangle_packet.h"

namespace patina {

struct BoxRef {
  float lo[3], hi[3];
  std::int32_t id;
};

// Splits by the surface-area rule with binned centroids. Permutes refs: a leaf child ~i is refs[i].
// refs must not be empty. No path is longer than kMaxTreeDepth nodes.
std::vector<WideNode> buildWideBvh(std::vector<BoxRef>& refs);

inline constexpr int kMaxTreeDepth = 88;

// Fits the children's cylinders, given the triangles in the order of refs.
void fitCylinders(std::vector<WideNode>& nodes, const std::vector<PacketTriangle>& triangles);

} // namespace patina
