// Nearest triangles of eight points at a time: the data and the kernel behind TriangleTree's
// lattice query. Everything is in the tree's own unit (half the mesh's longest side) about
// its own centre.
#pragma once

#include <cstdint>

namespace patina {

inline constexpr int kWide = 8; // children of a node, and points of a packet

// Bounds of the children, by coordinate: a box, and a short cylinder about the box's centre whose
// axis is the mean normal. Where a patch lies slanted in its box, far points see the box much
// nearer than the patch, and only the cylinder keeps them from searching a wide surrounding.
// An empty place has half = -infinity, so that no query enters it. child >= 0 is a node, < 0 is
// ~(index of a triangle).
struct alignas(32) WideNode {
  float centre[3][kWide], half[3][kWide];
  float normal[3][kWide];        // unit
  float low[kWide], high[kWide]; // extent along the normal, from the centre
  float radius[kWide];           // across it; infinite where there is no cylinder
  std::int32_t child[kWide];
};

// A triangle in its own plane's frame: A at the origin, B on the x axis, C above it. The distance
// of a point is then three edges in 2D and a height, without a division. The first 24 floats are
// read as three rows of eight, too.
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

// The nodes origin + spacing (i, j, k), 0 <= i, j, k < side, x fastest.
struct LatticeJob {
  const WideNode* nodes;
  const PacketTriangle* triangles;
  float triangle_size; // the mean longest edge
  double origin[3];
  double spacing;
  int side;            // even
  double max_distance; // farther nodes have no answer
  // Nearest triangle of a node, or -1, and its distance.
  std::int32_t* triangle;
  float* distance;
};

// All triangles that may be nearest to a point: those whose distance, as float knows it, is at most
// `slack` above the least. Slack must cover what float loses.
struct PointJob {
  const WideNode* nodes;
  const PacketTriangle* triangles;
  float point[3];
  float reach; // nothing farther matters
  float slack;
  static constexpr int kMost = 64;
  std::int32_t triangle[kMost];
  float distance2[kMost];
  int count; // the answer's; -1 if there are too many
};

// The same algorithms in the instructions of the processor at hand, or in those that every
// processor has; the difference is in the last bits.
void closestOnLattice(const LatticeJob& job);
void trianglesNear(PointJob& job);
void closestOnLatticePlain(const LatticeJob& job);
void trianglesNearPlain(PointJob& job);

} // namespace patina
