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

// Squared distances beyond which a point has no nearest triangle; places without one are farther.
inline constexpr float kFarthest = 1e36f;

// Eight triangles side by side, all that a node without nodes below it holds: one point meets them
// at once, without collecting them first. Frames as in PacketTriangle; a place without a triangle
// is far away.
struct alignas(64) TriangleBlock {
  float a[3][kWide];
  float along[3][kWide], across[3][kWide]; // along AB, in the plane towards C
  float ab[kWide];
  float c_x[kWide], c_y[kWide];         // C in the frame
  float per_bc2[kWide], per_ac2[kWide]; // 1 / length^2; 0 where there is no length
  std::int32_t face[kWide];
};
static_assert(sizeof(TriangleBlock) == 512);

// The nodes origin + spacing (i, j, k), 0 <= i, j, k < side, x fastest.
struct LatticeJob {
  const WideNode* nodes;
  std::int32_t inner;          // nodes from here on hold triangles alone: those of ...
  const TriangleBlock* blocks; // ... blocks[node - inner]
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

// All faces that may be nearest to a point: those whose distance, as float knows it, is at most
// `slack` above the least. Slack must cover what float loses. A face in several pieces may come
// more than once.
struct PointJob {
  const WideNode* nodes;
  std::int32_t inner;
  const TriangleBlock* blocks;
  const PacketTriangle* triangles;
  const std::int32_t* corners; // three a face, and
  const double* positions;     // three a corner: fetched ahead for those who will need them
  float point[3];
  float reach; // nothing farther matters
  float slack;
  static constexpr int kMost = 64;
  std::int32_t face[kMost];
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
