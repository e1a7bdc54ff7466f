#include "field/surface/iso_surface.h"

#include <cmath>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "field/surface/iso_block.h"

namespace patina {
namespace {

float isoInVoxels(const SurfaceField& field, double iso) {
  const double voxels = iso / field.grid.voxel;
  if (!(std::abs(voxels) < field.band))
    throw std::invalid_argument("isoSurface: the iso-value is not inside the band");
  return static_cast<float>(voxels);
}

// Both blocks that share an edge compute its vertex from the same two nodes in the same order, so
// that they agree bit for bit. A vertex keeps a little off the nodes: where phi == iso at a node,
// all the edges there would give one point and triangles without area.
Vec3 vertexOn(const SurfaceField& field, const CellPhi& cells, float iso,
              const std::array<int, 3>& block, int x, int y, int z, int axis) {
  constexpr double kOffNode = 1e-4; // of the edge
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

// vertex(x, y, z, axis) numbers the vertex on an edge whose low node has coordinates 0..8.
template <class Vertex, class Emit>
void triangulate(const IsoBlock& block, const Vertex& vertex, const Emit& emit) {
  const auto& cases = isoCases();
  block.forCells([&](int x, int y, int z, unsigned pattern) {
    const IsoCase& c = cases[pattern];
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

// A block's blocks at +0 and +1 along each axis: they own all the vertices its cells use.
struct Neighbour {
  const IsoBlock* block = nullptr;
  std::int32_t first_vertex = 0;
};

// Where cells are left out at the band's end, vertices may remain that no triangle uses.
void dropUnused(TriangleMesh& mesh) {
  std::vector<std::int32_t> number(mesh.positions.size(), -1);
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t) number[static_cast<std::size_t>(v)] = 0;
  std::int32_t count = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    mesh.positions[static_cast<std::size_t>(count)] = mesh.positions[v];
    number[v] = count++;
  }
  mesh.positions.resize(static_cast<std::size_t>(count));
  for (Triangle& t : mesh.triangles)
    for (std::int32_t& v : t) v = number[static_cast<std::size_t>(v)];
}

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
    skips_cells |= blocks[slot].skipsCells();
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
  if (skips_cells) dropUnused(mesh);
  return mesh;
}

} // namespace patina
