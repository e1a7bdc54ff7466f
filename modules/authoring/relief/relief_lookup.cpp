#include "authoring/relief/relief_lookup.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "field/construction/thickened_sheet.h"
#include "geometry/mesh/combined_mesh.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {
namespace {

bool isStored(float phi) {
  return std::abs(phi) < kBackground;
}

// Sources in the order of their faces, to find that of a face.
class FaceSources {
 public:
  explicit FaceSources(std::span<const ReliefInput> sources) : sources_(sources) {
    for (std::size_t i = 0; i < sources.size(); ++i)
      if (sources[i].uvs) order_.push_back(static_cast<std::int32_t>(i));
    std::sort(order_.begin(), order_.end(), [&](std::int32_t a, std::int32_t b) {
      return source(a).first_face < source(b).first_face;
    });
  }

  std::int32_t of(std::int32_t face) const {
    const std::int32_t at =
        objectOfFace(order_, face, [&](std::int32_t s) { return source(s).first_face; });
    if (at < 0) return BlockLookups::kNone;
    const std::int32_t s = order_[static_cast<std::size_t>(at)];
    return face - source(s).first_face < source(s).faces ? s : BlockLookups::kNone;
  }
  std::size_t count() const { return sources_.size(); }
  const ReliefInput& source(std::int32_t s) const { return sources_[static_cast<std::size_t>(s)]; }

 private:
  std::span<const ReliefInput> sources_;
  std::vector<std::int32_t> order_;
};

class FeetMaker {
 public:
  FeetMaker(const SurfaceField& field, const TriangleMesh& mesh,
            std::span<const ReliefInput> sources, Progress& progress)
      : field_(field), mesh_(mesh), sources_(sources), progress_(progress) {}

  ReliefLookups run() {
    feet_.block.resize(field_.blockCount());
    inBlocks([&](std::size_t slot) { survey(slot); });
    std::size_t entries = 0, mixed = 0;
    for (BlockLookups& block : feet_.block) {
      if (block.source == BlockLookups::kNone) continue;
      const std::size_t count = block.first;
      block.first = entries;
      entries += count;
      if (block.source != BlockLookups::kMixed) continue;
      block.first_source = mixed;
      mixed += count;
    }
    feet_.uv.resize(entries);
    feet_.source.resize(mixed, BlockLookups::kNone);
    feet_.plates.resize(sources_.count());
    inBlocks([&](std::size_t slot) { place(slot); });
    coarse();
    return std::move(feet_);
  }

 private:
  template <class Body> void inBlocks(const Body& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, field_.blockCount(), 16),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        if (progress_.cancelled()) return;
                        for (std::size_t slot = range.begin(); slot < range.end(); ++slot)
                          body(slot);
                      });
    progress_.throwIfCancelled();
  }

  // Determines the sources that a block uses; `first` temporarily holds the count of its nodes.
  void survey(std::size_t slot) {
    BlockLookups& feet = feet_.block[slot];
    const std::array<float, kBlockNodes> phi = field_.distance[slot]->phi();
    bool any = false;
    std::int32_t last = -1, source = BlockLookups::kNone;
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      if (!isStored(phi[n])) continue;
      const std::int32_t face = field_.face[slot]->at(n);
      if (face != last || !any) source = sources_.of(face);
      last = face;
      if (any && source != feet.source)
        feet.source = BlockLookups::kMixed;
      else if (!any)
        feet.source = source;
      any = true;
      ++feet.first;
    }
  }

  // Returns the position on a face at which the node at q, |phi| from the surface, reads.
  NodeUv uvOf(std::int32_t source, std::int32_t face, const Vec3& q, float phi) const {
    const auto f = static_cast<std::size_t>(face);
    const ReliefInput& own = sources_.source(source);
    const auto& uv = (*own.uvs)[static_cast<std::size_t>(face - own.first_face)];
    const Vec3 p = field_.grid.toWorld(q);
    const Vec3 a = mesh_.corner(f, 0), b = mesh_.corner(f, 1), c = mesh_.corner(f, 2);
    const Vec3 w = closestBarycentric(p, a, b, c);
    const Vec3 away = w[0] * a + w[1] * b + w[2] * c - p;
    if (isClosestToCap(phi, away.norm() / field_.grid.voxel)) return kNoLookup;
    const Vec2 at = w[0] * uv[0] + w[1] * uv[1] + w[2] * uv[2];
    return {static_cast<float>(at[0]), static_cast<float>(at[1])};
  }

  void place(std::size_t slot) {
    BlockLookups& feet = feet_.block[slot];
    if (feet.source == BlockLookups::kNone) return;
    const Index3& at = field_.block_at[slot];
    const std::array<float, kBlockNodes> phi = field_.distance[slot]->phi();
    std::size_t entry = 0;
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      if (!isStored(phi[n])) continue;
      const auto i = static_cast<int>(n);
      const std::int32_t face = field_.face[slot]->at(n);
      std::int32_t source = feet.source;
      if (source == BlockLookups::kMixed)
        source = feet_.source[feet.first_source + entry] = sources_.of(face);
      NodeUv& uv = feet_.uv[feet.first + entry++];
      if (source == BlockLookups::kNone) continue;
      uv = uvOf(source, face,
                Vec3(kBlockSide * at[0] + i % kBlockSide,
                     kBlockSide * at[1] + i / kBlockSide % kBlockSide,
                     kBlockSide * at[2] + i / (kBlockSide * kBlockSide)),
                phi[n]);
      if (uv == kNoLookup) {
        std::atomic_ref(feet_.plates[static_cast<std::size_t>(source)])
            .store(1, std::memory_order_relaxed);
        continue;
      }
      for (std::size_t a = 0; a < 2; ++a) {
        feet.low[a] = std::min(feet.low[a], uv[a]);
        feet.high[a] = std::max(feet.high[a], uv[a]);
      }
    }
  }

  // Returns the nearest stored face of the nodes about a point; -1 if there is none.
  std::int32_t faceNear(const Vec3& q) const {
    std::int32_t nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    const Vec3 p = field_.grid.toWorld(q);
    for (int c = 0; c < 8; ++c) {
      const std::int32_t face = field_.faceAt(static_cast<int>(std::floor(q[0])) + (c & 1),
                                              static_cast<int>(std::floor(q[1])) + (c >> 1 & 1),
                                              static_cast<int>(std::floor(q[2])) + (c >> 2));
      if (face < 0 || face == nearest) continue;
      const auto f = static_cast<std::size_t>(face);
      const Vec3 a = mesh_.corner(f, 0), b = mesh_.corner(f, 1), c2 = mesh_.corner(f, 2);
      const Vec3 w = closestBarycentric(p, a, b, c2);
      const double d = (w[0] * a + w[1] * b + w[2] * c2 - p).squaredNorm();
      if (d >= least) continue;
      least = d;
      nearest = face;
    }
    return nearest;
  }

  CoarseLookup coarseFoot(const CoarseNode& node, const Index3& at) const {
    constexpr double kOneDirection = 0.9; // shorter gradients mark several nearest points
    Vec3 foot = kBlockSide * Vec3(at[0], at[1], at[2]);
    std::int32_t face = field_.faceAt(kBlockSide * at[0], kBlockSide * at[1], kBlockSide * at[2]);
    const bool own = face >= 0;
    if (!own) {
      if (!(node.phi < 0)) return {CoarseLookup::kOutside, {}};
      const Vec3 g(node.gx, node.gy, node.gz);
      if (g.norm() < kOneDirection) return {CoarseLookup::kMean, {}};
      foot -= static_cast<double>(node.phi) * g;
      face = faceNear(foot);
      if (face < 0) return {CoarseLookup::kMean, {}};
    }
    const std::int32_t source = sources_.of(face);
    if (source == BlockLookups::kNone) return {};
    const NodeUv uv = uvOf(source, face, foot, own ? node.phi : kBackground);
    return uv == kNoLookup ? CoarseLookup{} : CoarseLookup{source, uv};
  }

  void coarse() {
    const Index3 n{field_.blocks[0] + 1, field_.blocks[1] + 1, field_.blocks[2] + 1};
    feet_.coarse.resize(field_.coarse.size());
    tbb::parallel_for(std::size_t{0}, feet_.coarse.size(), [&](std::size_t i) {
      const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
      feet_.coarse[i] =
          coarseFoot(field_.coarse[i], {static_cast<int>(i % nx), static_cast<int>(i / nx % ny),
                                        static_cast<int>(i / (nx * ny))});
    });
  }

  const SurfaceField& field_;
  const TriangleMesh& mesh_;
  const FaceSources sources_;
  Progress& progress_;
  ReliefLookups feet_;
};

} // namespace

std::size_t ReliefLookups::bytes() const {
  return block.size() * sizeof(block[0]) + uv.size() * sizeof(uv[0]) +
         source.size() * sizeof(source[0]) + coarse.size() * sizeof(coarse[0]);
}

ReliefLookups reliefLookups(const SurfaceField& field, const TriangleMesh& mesh,
                            std::span<const ReliefInput> sources, Progress& progress) {
  return FeetMaker(field, mesh, sources, progress).run();
}

} // namespace patina
