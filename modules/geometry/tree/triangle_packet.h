// Nearest triangles of eight points at a time: data and kernel of TriangleTree's lattice query. In
// the tree's own unit (half the mesh's longest side), relative to its own centre.
#pragma once

#include <cstdint>

namespace patina {

inline constexpr int kWide = 8; // children of a node, and points of a packet

// Bounds of the children by coordinate: a box, and a cylinder about the box's centre, short along
// the mean normal or long along slivers. The cylinder bounds what lies slanted in its box more
// tightly. An empty slot has half = -infinity, so that no query enters it. child >= 0 is a node, <
// 0 is ~(index of a triangle).
struct alignas(32) WideNode {
  float centre[3][kWide], half[3][kWide];
  float normal[3][kWide];        // axis of the cylinder, unit
  float low[kWide], high[kWide]; // extent along the axis, from the centre
  float radius[kWide];           // across the axis; infinite without a cylinder
  std::int32_t child[kWide];
};

// A triangle in its plane's frame: A at the origin, B on the x axis, C above it. A distance then
// takes three 2D edges and a height, without a division. The first 24 floats are also read as three
// rows of eight.
struct alignas(64) PacketTriangle {
  float a[3];                // A, rounded
  float axis[3][3];          // rows: along AB, in the plane towards C, normal
  float ab;                  // length of AB, the longest edge
  float bc_x, bc_y;          // unit direction of BC
  float bc_along, bc_across; // offsets of the coordinates along and across BC
  float bc;                  // length
  float ac_x, ac_y, ac;      // unit direction and length of AC
  std::int32_t face;
  float unused[2];
  double origin[3]; // A
};
static_assert(sizeof(PacketTriangle) == 128);

// Largest squared distance of a nearest triangle; empty slots are farther away.
inline constexpr float kFarthest = 1e36f;

// The eight triangles of a node without child nodes, side by side for one point. Frames as in
// PacketTriangle; an empty slot is far away.
struct alignas(64) TriangleBlock {
  float a[3][kWide];
  float along[3][kWide], across[3][kWide]; // along AB, in the plane towards C
  float ab[kWide];
  float c_x[kWide], c_y[kWide];         // C in the frame
  float per_bc2[kWide], per_ac2[kWide]; // 1 / length^2, or 0 without length
  std::int32_t face[kWide];
};
static_assert(sizeof(TriangleBlock) == 512);

// Query of the points origin + spacing (i, j, k), 0 <= i, j, k < side, x fastest.
struct LatticeJob {
  const WideNode* nodes;
  std::int32_t first_leaf_node; // first node with triangles only; node n has ...
  const TriangleBlock* blocks;  // ... blocks[n - first_leaf_node]
  const PacketTriangle* triangles;
  float triangle_size; // the mean longest edge
  double origin[3];
  double spacing;
  int side;            // even
  double max_distance; // farther points get no answer
  // Per point: index into `triangles` of the nearest one, or -1, and its distance.
  std::int32_t* triangle;
  float* distance;
};

// Collects all faces whose float distance is at most `slack` above the least. Slack must cover the
// rounding of float. A face in several pieces may occur more than once.
struct PointJob {
  const WideNode* nodes;
  std::int32_t first_leaf_node;
  const TriangleBlock* blocks;
  const PacketTriangle* triangles;
  const std::int32_t* corners; // three a face
  const double* positions;     // three a corner; prefetched for later use
  float point[3];
  float reach; // farther faces are ignored
  float slack;
  static constexpr int kMost = 64;
  std::int32_t face[kMost];
  float distance2[kMost];
  int count; // size of the answer; -1 if there are too many
};

// Run the best instructions of this processor. The kernel for every processor is packet_plain;
// results differ in the last bits.
void closestOnLattice(const LatticeJob& job);
void trianglesNear(PointJob& job);

} // namespace patina
