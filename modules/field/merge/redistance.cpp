#include "field/merge/redistance.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <tbb/parallel_for.h>

#include "field/construction/thickened_sheet.h"
#include "field/merge/union_surface.h"
#include "geometry/mesh/combined_mesh.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {
namespace {

constexpr double kSame = 1e-3; // [voxel]

class Redistancer {
 public:
  Redistancer(const SurfaceField& merged, std::span<const FieldPart> parts,
              const BlockLattice& lattice, const TriangleMesh& joint, const Progress& progress)
      : merged_(merged), parts_(parts), nodes_(nodesOf(parts)), lattice_(lattice), joint_(joint),
        progress_(progress), surface_(closedUnionSurface(parts, lattice, joint, progress)),
        tree_(surface_.mesh) {
    BlockBox all;
    for (const FieldPart& part : parts) all.extend(part.blocks());
    low_ = all.low;
  }

  Redistanced run() {
    SurfaceField& field = result_.field;
    field = merged_;
    std::vector<std::uint8_t> gone(field.blockCount());
    tbb::parallel_for(std::size_t{0}, field.blockCount(), [&](std::size_t slot) {
      if (!progress_.cancelled() && overlaps(merged_.block_at[slot], 0)) gone[slot] = !keep(slot);
    });
    progress_.throwIfCancelled();
    coarse();
    progress_.throwIfCancelled();
    dropBlocks(gone);
    result_.nodes = changed_;
    return std::move(result_);
  }

 private:
  // Returns true if two or more parts store the block; more = 1 counts block corners.
  bool overlaps(const Index3& block, int more) const {
    int count = 0;
    for (const FieldPart& part : parts_) {
      BlockBox box = part.blocks();
      for (int& high : box.high) high += more;
      count += box.contains({block[0] + low_[0], block[1] + low_[1], block[2] + low_[2]});
    }
    return count > 1;
  }

  Vec3 footOn(std::int32_t face, const Vec3& p) const {
    const auto f = static_cast<std::size_t>(face);
    const Vec3 a = joint_.corner(f, 0), b = joint_.corner(f, 1), c = joint_.corner(f, 2);
    const Vec3 w = closestBarycentric(p, a, b, c);
    return w[0] * a + w[1] * b + w[2] * c;
  }

  // Returns false if no node remains within the band.
  bool keep(std::size_t slot) {
    const FaceBlock& old_faces = *merged_.face[slot];
    DistanceNodes distance;
    merged_.distance[slot]->unpack(distance);
    FaceNodes faces;
    std::size_t count = 0;
    std::int32_t warm = -1;
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      const std::int32_t face = faces.face[n] = old_faces.at(n);
      if (face < 0 || !(distance.phi[n] < 0)) continue;
      const Index3 at = BlockNode{merged_.block_at[slot], n}.at();
      const Vec3 p = merged_.grid.toWorld(Vec3(at[0], at[1], at[2]));
      const Vec3 nearest = footOn(face, p);
      const bool at_cap = isClosestToCap(distance.phi[n], (nearest - p).norm() / lattice_.voxel);
      const Vec3 foot = (nearest - lattice_.anchor) / lattice_.voxel;
      if (!at_cap &&
          !isHidden(parts_, nodes_, objectOfFace(parts_, face, &FieldPart::first_face), foot))
        continue;
      const auto found = tree_.closestPointWithin(p, merged_.band * lattice_.voxel, warm);
      const float phi =
          found ? -static_cast<float>(std::min(found->distance / lattice_.voxel, merged_.band))
                : -kBackground;
      // The minimum over the parts is a lower bound of the depth. Caps are stored trimmed, which
      // equals the full cap up to rounding if no other part covers it.
      const auto known = static_cast<double>(distance.phi[n]);
      if (!(static_cast<double>(phi) < known - (at_cap ? kSame : 0))) continue;
      ++count;
      distance.phi[n] = phi;
      faces.face[n] = -1;
      if (found) {
        warm = found->surface.face;
        faces.face[n] = surface_.face[static_cast<std::size_t>(warm)];
      }
    }
    if (count > 0) {
      changed_ += count;
      result_.field.distance[slot] = std::make_shared<const DistanceBlock>(distance);
      result_.field.face[slot] = std::make_shared<const FaceBlock>(faces);
    }
    return std::any_of(faces.face.begin(), faces.face.end(), [](std::int32_t f) { return f >= 0; });
  }

  void coarse() {
    const Index3 n{merged_.blocks[0] + 1, merged_.blocks[1] + 1, merged_.blocks[2] + 1};
    tbb::parallel_for(std::size_t{0}, merged_.coarse.size(), [&](std::size_t i) {
      CoarseNode& node = result_.field.coarse[i];
      const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
      const Index3 at{static_cast<int>(i % nx), static_cast<int>(i / nx % ny),
                      static_cast<int>(i / (nx * ny))};
      if (progress_.cancelled() || !(node.phi < 0) || !overlaps(at, 1)) return;
      const Vec3 p = merged_.grid.toWorld(kBlockSide * Vec3(at[0], at[1], at[2]));
      const ClosestPoint found = tree_.closestPoint(p);
      const double depth = found.distance / lattice_.voxel;
      if (!(depth > kSame - static_cast<double>(node.phi))) return;
      const Vec3 g = (found.point - p) / found.distance;
      node = {-static_cast<float>(depth), static_cast<float>(g[0]), static_cast<float>(g[1]),
              static_cast<float>(g[2])};
      ++changed_;
    });
  }

  // Blocks without nodes in the band become inside blocks.
  void dropBlocks(const std::vector<std::uint8_t>& gone) {
    SurfaceField& field = result_.field;
    std::size_t kept = 0;
    for (std::size_t slot = 0; slot < gone.size(); ++slot) {
      const Index3 at = field.block_at[slot];
      std::int32_t& top = field.block_index[static_cast<std::size_t>(
          (at[2] * field.blocks[1] + at[1]) * field.blocks[0] + at[0])];
      if (gone[slot]) {
        top = SurfaceField::kInside;
        continue;
      }
      top = static_cast<std::int32_t>(kept);
      field.block_at[kept] = at;
      field.distance[kept] = std::move(field.distance[slot]);
      field.face[kept] = std::move(field.face[slot]);
      ++kept;
    }
    field.block_at.resize(kept);
    field.distance.resize(kept);
    field.face.resize(kept);
  }

  const SurfaceField& merged_;
  std::span<const FieldPart> parts_;
  const std::deque<NodeReader> nodes_;
  const BlockLattice& lattice_;
  const TriangleMesh& joint_;
  const Progress& progress_;
  const UnionSurface surface_;
  const TriangleTree tree_;
  Index3 low_{};
  Redistanced result_;
  std::atomic<std::size_t> changed_{0};
};

} // namespace

Redistanced redistanced(const SurfaceField& merged, std::span<const FieldPart> parts,
                        const BlockLattice& lattice, const TriangleMesh& joint,
                        const Progress& progress) {
  if (merged.face.size() != merged.blockCount())
    throw std::invalid_argument("redistanced: the field has no face layer");
  return Redistancer(merged, parts, lattice, joint, progress).run();
}

} // namespace patina
