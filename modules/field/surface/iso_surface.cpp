#include "field/surface/iso_surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "field/store/node_reader.h"

namespace patina {

const std::array<CellEdge, kCellEdges> kCellEdge{{{0, 0, 0, 0},
                                                  {0, 1, 0, 0},
                                                  {0, 0, 1, 0},
                                                  {0, 1, 1, 0},
                                                  {0, 0, 0, 1},
                                                  {1, 0, 0, 1},
                                                  {0, 0, 1, 1},
                                                  {1, 0, 1, 1},
                                                  {0, 0, 0, 2},
                                                  {1, 0, 0, 2},
                                                  {0, 1, 0, 2},
                                                  {1, 1, 0, 2}}};

namespace {

int lowCorner(const CellEdge& edge) {
  return edge.x + 2 * edge.y + 4 * edge.z;
}
int highCorner(const CellEdge& edge) {
  return lowCorner(edge) + (1 << edge.axis);
}

int edgeBetween(int a, int b) {
  for (int e = 0; e < kCellEdges; ++e) {
    const CellEdge& edge = kCellEdge[static_cast<std::size_t>(e)];
    if (lowCorner(edge) == std::min(a, b) && highCorner(edge) == std::max(a, b)) return e;
  }
  assert(false);
  return -1;
}

// Returns the corners of the face at `side` of `axis`, counter-clockwise as seen from outside the
// cell.
std::array<int, 4> faceCorners(int axis, int side) {
  const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
  if (side == 1) return {base, base + u, base + u + v, base + v};
  return {base, base + v, base + u + v, base + u};
}

// next[e] is the crossed edge that follows e on the loop through e.
std::array<int, kCellEdges> segments(unsigned inside) {
  std::array<int, kCellEdges> next;
  next.fill(-1);
  const auto is_inside = [&](int corner) { return (inside >> corner & 1U) != 0; };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const std::array<int, 4> corner = faceCorners(axis, side);
      // Around the face, each run of inside corners is cut off by one segment.
      for (std::size_t i = 0; i < 4; ++i) {
        if (is_inside(corner[i]) || !is_inside(corner[(i + 1) % 4])) continue;
        std::size_t last = (i + 1) % 4;
        while (is_inside(corner[(last + 1) % 4])) last = (last + 1) % 4;
        const int entering = edgeBetween(corner[i], corner[(i + 1) % 4]);
        const int leaving = edgeBetween(corner[last], corner[(last + 1) % 4]);
        next[static_cast<std::size_t>(entering)] = leaving;
      }
    }
  return next;
}

using Triangles = std::vector<std::array<int, 3>>;

// Triangulates loop[first .. last] on the base first-last with the fewest diagonals in faces of the
// cell, and returns their number.
int triangulate(const std::vector<int>& loop, std::size_t first, std::size_t last,
                Triangles& best) {
  best.clear();
  if (last - first < 2) return 0;
  int fewest = 1000;
  for (std::size_t apex = first + 1; apex < last; ++apex) {
    Triangles left, right;
    int bad = triangulate(loop, first, apex, left) + triangulate(loop, apex, last, right);
    if (apex - first > 1) bad += shareFace(loop[first], loop[apex]);
    if (last - apex > 1) bad += shareFace(loop[apex], loop[last]);
    if (bad >= fewest) continue;
    fewest = bad;
    best = {{loop[first], loop[apex], loop[last]}};
    best.insert(best.end(), left.begin(), left.end());
    best.insert(best.end(), right.begin(), right.end());
  }
  return fewest;
}

MarchingCubesCase makeCase(unsigned inside) {
  MarchingCubesCase result;
  for (const std::vector<int>& loop : isoLoops(inside)) {
    Triangles triangles;
    triangulate(loop, 0, loop.size() - 1, triangles);
    for (const auto& t : triangles) {
      assert(result.count < result.triangle.size());
      for (std::size_t c = 0; c < 3; ++c)
        result.triangle[result.count][c] = static_cast<std::uint8_t>(t[c]);
      ++result.count;
    }
  }
  return result;
}

} // namespace

std::vector<std::vector<int>> isoLoops(unsigned inside) {
  std::array<int, kCellEdges> next = segments(inside);
  std::vector<std::vector<int>> loops;
  for (std::size_t start = 0; start < kCellEdges; ++start) {
    if (next[start] < 0) continue;
    std::vector<int> loop;
    for (int e = static_cast<int>(start); next[static_cast<std::size_t>(e)] >= 0;) {
      loop.push_back(e);
      const int following = next[static_cast<std::size_t>(e)];
      next[static_cast<std::size_t>(e)] = -1;
      e = following;
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

bool shareFace(int edge_a, int edge_b) {
  const CellEdge& a = kCellEdge[static_cast<std::size_t>(edge_a)];
  const CellEdge& b = kCellEdge[static_cast<std::size_t>(edge_b)];
  const std::array<int, 3> at_a{a.x, a.y, a.z}, at_b{b.x, b.y, b.z};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    if (a.axis != axis && b.axis != axis && at_a[i] == at_b[i]) return true;
  }
  return false;
}

const std::array<MarchingCubesCase, 256>& marchingCubesCases() {
  static const std::array<MarchingCubesCase, 256> cases = [] {
    std::array<MarchingCubesCase, 256> made;
    for (unsigned inside = 0; inside < 256; ++inside) made[inside] = makeCase(inside);
    return made;
  }();
  return cases;
}

namespace {

// One block's part of the iso-surface: which of its nodes are inside, and the indices of the
// vertices on its own edges. Small, so that all blocks fit in memory while a mesh is assembled.

// phi [voxel] of the block's nodes and the first layer of its upper neighbours, x fastest.
using CellPhi = std::array<float, kSampleSide * kSampleSide * kSampleSide>;

class IsoBlock {
 public:
  IsoBlock() = default;
  IsoBlock(const CellPhi& phi, float iso);

  bool empty() const { return triangles_ == 0 && vertices_ == 0; }
  int vertexCount() const { return vertices_; }
  int triangleCount() const { return triangles_; }
  // Returns true if the surface meets a cell with a node beyond the band, which is left out.
  bool isClippedByBand() const { return skips_cells_; }

  // Returns the vertex on the edge from own node (x, y, z), 0..7, along axis. It must exist.
  int vertex(int x, int y, int z, int axis) const {
    const auto row = static_cast<std::size_t>((axis * kBlockSide + z) * kBlockSide + y);
    return first_[row] + std::popcount(crossed_[row] & ((1U << x) - 1U));
  }

  // Calls visit(x, y, z, axis) for each vertex on an own edge, in index order.
  template <class Visit> void forVertices(const Visit& visit) const {
    for (int axis = 0, row = 0; axis < 3; ++axis)
      for (int z = 0; z < kBlockSide; ++z)
        for (int y = 0; y < kBlockSide; ++y, ++row)
          for (unsigned m = crossed_[static_cast<std::size_t>(row)]; m != 0; m &= m - 1)
            visit(std::countr_zero(m), y, z, axis);
  }

  // Calls visit(x, y, z, pattern) for each complete cell that the surface meets.
  template <class Visit> void forCells(const Visit& visit) const {
    for (int z = 0; z < kBlockSide; ++z)
      for (int y = 0; y < kBlockSide; ++y) {
        const std::array<unsigned, 4> in = cellRows(inside_, y, z);
        for (unsigned m = meeting(in) & complete(y, z); m != 0; m &= m - 1) {
          const int x = std::countr_zero(m);
          unsigned pattern = 0;
          for (unsigned r = 0; r < 4; ++r) pattern |= (in[r] >> x & 3U) << 2 * r;
          visit(x, y, z, pattern);
        }
      }
  }

 private:
  // One bit per node along x, one row for each (y, z) of the 9 x 9.
  using Rows = std::array<std::uint16_t, kSampleSide * kSampleSide>;

  static std::array<unsigned, 4> cellRows(const Rows& rows, int y, int z) {
    const auto at = static_cast<std::size_t>(z * kSampleSide + y);
    return {rows[at], rows[at + 1], rows[at + kSampleSide], rows[at + kSampleSide + 1]};
  }
  // Returns the cells of a row whose eight nodes are not all on one side.
  static unsigned meeting(const std::array<unsigned, 4>& in) {
    const unsigned any = in[0] | in[1] | in[2] | in[3], all = in[0] & in[1] & in[2] & in[3];
    return (any | any >> 1) & ~(all & all >> 1) & 0xFFU;
  }
  unsigned complete(int y, int z) const {
    const std::array<unsigned, 4> stored = cellRows(stored_, y, z);
    const unsigned all = stored[0] & stored[1] & stored[2] & stored[3];
    return all & all >> 1;
  }
  void numberVertices();
  void countTriangles();

  Rows inside_{}, stored_{};
  std::array<std::uint8_t, 3 * kBlockSide * kBlockSide> crossed_{}; // [axis][z][y], one bit each x
  std::array<std::uint16_t, 3 * kBlockSide * kBlockSide> first_{};  // row's first
  int vertices_ = 0, triangles_ = 0;
  bool skips_cells_ = false;
};

CellPhi gatherCells(const NodeReader& nodes, std::int32_t slot) {
  const SurfaceField& field = nodes.field();
  CellPhi cells;
  const std::array<int, 3>& at = field.block_at[static_cast<std::size_t>(slot)];
  for (int dz = 0; dz < 2; ++dz)
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx) {
        const int bx = at[0] + dx, by = at[1] + dy, bz = at[2] + dz;
        const bool in_table = bx < field.blocks[0] && by < field.blocks[1] && bz < field.blocks[2];
        const std::int32_t from = in_table ? field.slotOf(bx, by, bz) : SurfaceField::kOutside;
        const float* phi =
            from >= 0 ? nodes.block(static_cast<std::size_t>(from)).phi.data() : nullptr;
        const int nx = dx ? 1 : kBlockSide, ny = dy ? 1 : kBlockSide, nz = dz ? 1 : kBlockSide;
        for (int z = 0; z < nz; ++z)
          for (int y = 0; y < ny; ++y) {
            float* row = &cells[static_cast<std::size_t>(
                ((dz * kBlockSide + z) * kSampleSide + dy * kBlockSide + y) * kSampleSide +
                dx * kBlockSide)];
            if (phi)
              std::copy_n(phi + (z * kBlockSide + y) * kBlockSide, nx, row);
            else
              std::fill_n(row, nx, backgroundOf(from));
          }
      }
  return cells;
}

IsoBlock::IsoBlock(const CellPhi& phi, float iso) {
  const float* value = phi.data();
  unsigned any = 0, all = ~0U;
  for (std::size_t row = 0; row < inside_.size(); ++row, value += kSampleSide) {
    unsigned inside = 0, stored = 0;
    for (int x = 0; x < kSampleSide; ++x) {
      inside |= static_cast<unsigned>(value[x] < iso) << x;
      stored |= static_cast<unsigned>(std::abs(value[x]) < kBackground) << x;
    }
    inside_[row] = static_cast<std::uint16_t>(inside);
    stored_[row] = static_cast<std::uint16_t>(stored);
    any |= inside;
    all &= inside;
  }
  if (any == 0 || (all & 0x1FFU) == 0x1FFU) return;
  numberVertices();
  countTriangles();
}

void IsoBlock::numberVertices() {
  std::size_t row = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int z = 0; z < kBlockSide; ++z)
      for (int y = 0; y < kBlockSide; ++y, ++row) {
        const auto at = static_cast<std::size_t>(z * kSampleSide + y);
        const std::size_t next = at + (axis == 1 ? 1 : axis == 2 ? kSampleSide : 0);
        const unsigned shift = axis == 0 ? 1 : 0;
        const unsigned change = inside_[at] ^ static_cast<unsigned>(inside_[next] >> shift);
        const unsigned stored = stored_[at] & static_cast<unsigned>(stored_[next] >> shift);
        crossed_[row] = static_cast<std::uint8_t>(change & stored & 0xFFU);
        first_[row] = static_cast<std::uint16_t>(vertices_);
        vertices_ += std::popcount(crossed_[row]);
      }
}

void IsoBlock::countTriangles() {
  const auto& cases = marchingCubesCases();
  forCells([&](int, int, int, unsigned pattern) { triangles_ += cases[pattern].count; });
  for (int z = 0; z < kBlockSide; ++z)
    for (int y = 0; y < kBlockSide; ++y)
      skips_cells_ |= (meeting(cellRows(inside_, y, z)) & ~complete(y, z)) != 0;
}

float isoInVoxels(const SurfaceField& field, double iso) {
  const double voxels = iso / field.grid.voxel;
  if (!(std::abs(voxels) < field.band))
    throw std::invalid_argument("isoSurface: the iso-value is not inside the band");
  return static_cast<float>(voxels);
}

// Both blocks at an edge compute its vertex from the same two nodes in the same order and agree bit
// for bit. A vertex keeps a small distance from the nodes: for phi == iso at a node all edges there
// would give one point and triangles without area.
Vec3 vertexOn(const SurfaceField& field, const CellPhi& cells, float iso,
              const std::array<int, 3>& block, int x, int y, int z, int axis) {
  constexpr double kOffNode = 1e-4; // fraction of the edge
  const int step = axis == 0 ? 1 : axis == 1 ? kSampleSide : kSampleSide * kSampleSide;
  const int low = (z * kSampleSide + y) * kSampleSide + x;
  const double a = static_cast<double>(cells[static_cast<std::size_t>(low)]);
  const double b = static_cast<double>(cells[static_cast<std::size_t>(low + step)]);
  const double t =
      std::fmin(std::fmax((static_cast<double>(iso) - a) / (b - a), kOffNode), 1 - kOffNode);
  Vec3 q(block[0] * kBlockSide + x, block[1] * kBlockSide + y, block[2] * kBlockSide + z);
  q[axis] += t;
  return field.grid.toWorld(q);
}

// vertex(x, y, z, axis) returns the vertex on an edge whose lower node has coordinates 0..8.
template <class Vertex, class Emit>
void triangulate(const IsoBlock& block, const Vertex& vertex, const Emit& emit) {
  const auto& cases = marchingCubesCases();
  block.forCells([&](int x, int y, int z, unsigned pattern) {
    const MarchingCubesCase& c = cases[pattern];
    for (std::size_t t = 0; t < c.count; ++t) {
      Triangle triangle;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const CellEdge& edge = kCellEdge[c.triangle[t][corner]];
        triangle[corner] = vertex(x + edge.x, y + edge.y, z + edge.z, edge.axis);
      }
      emit(triangle);
    }
  });
}

template <class Body> void parallelFor(std::size_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 32),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
                    });
}

// The blocks at +0 and +1 along each axis, which own all vertices that a block's cells use.
struct Neighbour {
  const IsoBlock* block = nullptr;
  std::int32_t first_vertex = 0;
};

} // namespace

TriangleMesh isoSurface(const SurfaceField& field, double iso) {
  const float level = isoInVoxels(field, iso);
  const std::size_t count = field.blockCount();
  const NodeReader nodes(field);
  std::vector<IsoBlock> blocks(count);
  parallelFor(count, [&](std::size_t slot) {
    blocks[slot] = IsoBlock(gatherCells(nodes, static_cast<std::int32_t>(slot)), level);
  });

  std::vector<std::int32_t> first_vertex(count), first_triangle(count);
  std::int32_t vertices = 0, triangles = 0;
  bool skips_cells = false;
  for (std::size_t slot = 0; slot < count; ++slot) {
    first_vertex[slot] = vertices;
    first_triangle[slot] = triangles;
    vertices += blocks[slot].vertexCount();
    triangles += blocks[slot].triangleCount();
    skips_cells |= blocks[slot].isClippedByBand();
  }

  TriangleMesh mesh;
  mesh.positions.resize(static_cast<std::size_t>(vertices));
  mesh.triangles.resize(static_cast<std::size_t>(triangles));
  parallelFor(count, [&](std::size_t slot) {
    if (blocks[slot].empty()) return;
    const std::array<int, 3>& at = field.block_at[slot];
    const CellPhi cells = gatherCells(nodes, static_cast<std::int32_t>(slot));
    Vec3* position = mesh.positions.data() + first_vertex[slot];
    blocks[slot].forVertices([&](int x, int y, int z, int axis) {
      *position++ = vertexOn(field, cells, level, at, x, y, z, axis);
    });

    std::array<Neighbour, 8> owner;
    for (std::size_t n = 0; n < 8; ++n) {
      const int bx = at[0] + static_cast<int>(n & 1), by = at[1] + static_cast<int>(n >> 1 & 1),
                bz = at[2] + static_cast<int>(n >> 2);
      if (bx >= field.blocks[0] || by >= field.blocks[1] || bz >= field.blocks[2]) continue;
      const std::int32_t from = field.slotOf(bx, by, bz);
      if (from < 0) continue;
      owner[n] = {&blocks[static_cast<std::size_t>(from)],
                  first_vertex[static_cast<std::size_t>(from)]};
    }
    const auto vertex = [&](int x, int y, int z, int axis) {
      const Neighbour& n = owner[static_cast<std::size_t>(x / kBlockSide + 2 * (y / kBlockSide) +
                                                          4 * (z / kBlockSide))];
      return n.first_vertex + n.block->vertex(x % kBlockSide, y % kBlockSide, z % kBlockSide, axis);
    };
    Triangle* triangle = mesh.triangles.data() + first_triangle[slot];
    triangulate(blocks[slot], vertex, [&](const Triangle& t) { *triangle++ = t; });
  });
  if (skips_cells) removeUnusedVertices(mesh);
  return mesh;
}

} // namespace patina
