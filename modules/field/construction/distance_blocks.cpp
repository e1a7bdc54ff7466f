#include "field/construction/distance_blocks.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>

#include <tbb/parallel_for.h>

#include "core/memory_left.h"

namespace patina {
namespace {

constexpr int kTile = 4; // lattice points a side in queries

std::size_t cellCount(const Index3& n) {
  return static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
         static_cast<std::size_t>(n[2]);
}

Index3 cellAt(std::size_t index, const Index3& n) {
  const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
  return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
          static_cast<int>(index / (nx * ny))};
}

Index3 tilesOver(const Index3& n) {
  return {(n[0] + kTile - 1) / kTile, (n[1] + kTile - 1) / kTile, (n[2] + kTile - 1) / kTile};
}

struct Tile {
  std::array<float, kTile * kTile * kTile> distance;
  std::array<std::int32_t, kTile * kTile * kTile> face;
};

// Calls visit(point, distance in spacings, face, linear index) for every lattice point 0 <= point <
// n, in parallel, tile by tile. Stops early on cancellation.
template <typename Visit>
void forLattice(const TriangleTree& tree, const Vec3& origin, double spacing, const Index3& n,
                double max_distance, const Progress& progress, Visit visit) {
  const Index3 tiles = tilesOver(n);
  tbb::parallel_for(std::size_t{0}, cellCount(tiles), [&](std::size_t t) {
    if (progress.cancelled()) return;
    const Index3 tile = cellAt(t, tiles);
    const Vec3 corner = kTile * spacing * Vec3(tile[0], tile[1], tile[2]);
    Tile answer;
    tree.closestOnLattice(origin + corner, spacing, kTile, max_distance, answer.distance,
                          answer.face);
    for (std::size_t i = 0; i < answer.face.size(); ++i) {
      const Index3 in = cellAt(i, {kTile, kTile, kTile});
      const Index3 at{kTile * tile[0] + in[0], kTile * tile[1] + in[1], kTile * tile[2] + in[2]};
      if (at[0] >= n[0] || at[1] >= n[1] || at[2] >= n[2]) continue;
      visit(at, answer.distance[i], answer.face[i],
            static_cast<std::size_t>((at[2] * n[1] + at[1]) * n[0] + at[0]));
    }
  });
}

// Returns the blocks whose centre is close enough for a node to be in the band.
std::vector<std::size_t> candidates(const TriangleTree& tree, const FieldGrid& grid, double band,
                                    const Index3& blocks, const Progress& progress) {
  const double half = 0.5 * (kBlockSide - 1);
  const double reach = (band + half * std::sqrt(3.0)) * (1 + 1e-5);
  std::vector<std::uint8_t> near(cellCount(blocks));
  forLattice(tree, grid.toWorld(Vec3::Constant(half)), kBlockSide * grid.voxel, blocks,
             reach * grid.voxel, progress,
             [&](const Index3&, float, std::int32_t face, std::size_t i) { near[i] = face >= 0; });
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < near.size(); ++i)
    if (near[i]) result.push_back(i);
  return result;
}

// Measured memory [bytes], rounded up: of a stored block with its share of signing and writing; of
// each block position, stored or not.
constexpr double kBytesOfBlock = 3500, kBytesOfPlace = 150;

void requireRoom(const FieldGrid& grid, std::size_t places, std::size_t blocks) {
  const auto cells = [&](std::size_t axis) { return std::to_string(grid.nodes[axis] - 1); };
  requireMemory(kBytesOfPlace * static_cast<double>(places) +
                    kBytesOfBlock * static_cast<double>(blocks),
                "a field of " + cells(0) + " x " + cells(1) + " x " + cells(2) + " cells",
                "; choose a larger voxel or a lower resolution");
}

struct Foot {
  double distance = 0; // [m]
  Vec3 direction = Vec3::Zero();
};

double distanceTo(const TriangleMesh& mesh, std::int32_t face, const Vec3& p) {
  const auto f = static_cast<std::size_t>(face);
  const Vec3 a = mesh.corner(f, 0), b = mesh.corner(f, 1), c = mesh.corner(f, 2);
  const Vec3 w = closestBarycentric(p, a, b, c);
  return (w[0] * (p - a) + w[1] * (p - b) + w[2] * (p - c)).norm();
}

Foot footOn(const TriangleMesh& mesh, std::int32_t face, const Vec3& p, double voxel) {
  const auto f = static_cast<std::size_t>(face);
  const Vec3 a = mesh.corner(f, 0), b = mesh.corner(f, 1), c = mesh.corner(f, 2);
  const Vec3 w = closestBarycentric(p, a, b, c);
  const Vec3 r = p - (w[0] * a + w[1] * b + w[2] * c);
  const double d = r.norm();
  return {d, d > 1e-6 * voxel ? Vec3(r / d) : faceNormal(mesh, f)};
}

// On a medial axis several faces are nearest. Averaging their directions gives a short gradient
// there, which marks it as unreliable.
std::vector<CoarseNode> coarseNodes(const TriangleMesh& mesh, const TriangleTree& tree,
                                    const FieldGrid& grid, const Index3& blocks,
                                    const Progress& progress) {
  constexpr double kAsNear = 0.1;    // [voxel]
  constexpr double kMinCosine = 0.5; // cosine
  const Index3 corners{blocks[0] + 1, blocks[1] + 1, blocks[2] + 1};
  std::vector<std::int32_t> nearest(cellCount(corners), -1);
  forLattice(tree, grid.origin, kBlockSide * grid.voxel, corners,
             std::numeric_limits<double>::infinity(), progress,
             [&](const Index3&, float, std::int32_t face, std::size_t i) { nearest[i] = face; });
  progress.throwIfCancelled(); // The result is complete from here.
  std::vector<CoarseNode> coarse(nearest.size());
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(corners[0]),
                                          static_cast<std::size_t>(corners[0] * corners[1])};
  tbb::parallel_for(std::size_t{0}, coarse.size(), [&](std::size_t i) {
    const Index3 at = cellAt(i, corners);
    const Vec3 p = grid.toWorld(kBlockSide * Vec3(at[0], at[1], at[2]));
    const Foot foot = footOn(mesh, nearest[i], p, grid.voxel);
    Vec3 sum = foot.direction;
    std::array<std::int32_t, 7> faces{nearest[i]};
    std::size_t known = 1, count = 1;
    const auto meet = [&](std::int32_t face) {
      const auto end = faces.begin() + static_cast<std::ptrdiff_t>(known);
      if (std::find(faces.begin(), end, face) != end) return;
      faces[known++] = face;
      const Foot other = footOn(mesh, face, p, grid.voxel);
      if (other.distance > foot.distance + kAsNear * grid.voxel ||
          other.direction.dot(foot.direction) > kMinCosine)
        return;
      sum += other.direction;
      ++count;
    };
    for (std::size_t a = 0; a < 3; ++a) {
      if (at[a] > 0) meet(nearest[i - stride[a]]);
      if (at[a] + 1 < corners[a]) meet(nearest[i + stride[a]]);
    }
    const Vec3 g = sum / static_cast<double>(count);
    coarse[i] = {static_cast<float>(foot.distance / grid.voxel), static_cast<float>(g[0]),
                 static_cast<float>(g[1]), static_cast<float>(g[2])};
  });
  return coarse;
}

struct Block {
  std::shared_ptr<const DistanceBlock> distance;
  std::shared_ptr<const FaceBlock> face;
};

// Returns null if no node is within the band. Searches in float, where the last bit depends on the
// scale, but stores the nearest face's distance in double, which does not.
Block blockAt(const TriangleMesh& mesh, const TriangleTree& tree, const FieldGrid& grid,
              double band, const Index3& at) {
  DistanceNodes distances;
  FaceNodes nearest;
  const Vec3 corner = grid.toWorld(kBlockSide * Vec3(at[0], at[1], at[2]));
  auto& phi = distances.phi;
  auto& face = nearest.face;
  tree.closestOnLattice(corner, grid.voxel, kBlockSide, band * grid.voxel, phi, face);
  std::int32_t any = -1;
  for (std::size_t i = 0; i < phi.size(); ++i) {
    any = std::max(any, face[i]);
    if (face[i] < 0) {
      phi[i] = kBackground;
      continue;
    }
    const Index3 node = BlockNode{at, i}.at();
    const Vec3 p = grid.toWorld(Vec3(node[0], node[1], node[2]));
    const double d = distanceTo(mesh, face[i], p) / grid.voxel;
    phi[i] = static_cast<float>(std::min(d, band));
  }
  if (any < 0) return {};
  return {std::make_shared<const DistanceBlock>(distances),
          std::make_shared<const FaceBlock>(nearest)};
}

} // namespace

FieldBuilder distanceBlocks(const TriangleMesh& mesh, const TriangleTree& tree,
                            const FieldGrid& grid, double band, Progress& progress,
                            double from_fraction, double to_fraction) {
  FieldBuilder builder;
  SurfaceField& field = builder.field;
  field.grid = grid;
  field.band = band;
  for (std::size_t a = 0; a < 3; ++a)
    field.blocks[a] = (grid.nodes[a] + kBlockSide - 1) / kBlockSide;

  requireRoom(grid, cellCount(field.blocks), 0);
  const std::vector<std::size_t> near = candidates(tree, grid, band, field.blocks, progress);
  progress.throwIfCancelled();
  requireRoom(grid, cellCount(field.blocks), near.size());
  std::vector<Block> blocks(near.size());
  std::atomic<std::size_t> done{0};
  constexpr std::size_t kReportEvery = 64;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, near.size(), 8), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      if (progress.cancelled()) return;
      blocks[i] = blockAt(mesh, tree, grid, band, cellAt(near[i], field.blocks));
      const std::size_t count = done.fetch_add(1, std::memory_order_relaxed);
      if (count % kReportEvery == 0)
        progress.report(from_fraction + (to_fraction - from_fraction) * static_cast<double>(count) /
                                            static_cast<double>(near.size()),
                        "distances");
    }
  });
  progress.throwIfCancelled();

  field.block_index.assign(cellCount(field.blocks), SurfaceField::kOutside);
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (!blocks[i].distance) continue;
    field.block_index[near[i]] = static_cast<std::int32_t>(field.block_at.size());
    field.block_at.push_back(cellAt(near[i], field.blocks));
    builder.distance.push_back(std::move(blocks[i].distance));
    builder.face.push_back(std::move(blocks[i].face));
  }
  field.coarse = coarseNodes(mesh, tree, grid, field.blocks, progress);
  progress.throwIfCancelled();
  return builder;
}

} // namespace patina
