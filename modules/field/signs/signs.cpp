#include "field/signs/signs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "field/signs/sign_components.h"
#include "field/signs/sign_slivers.h"
#include "geometry/sides/pseudonormal_side.h"

namespace patina {

using signs::Components;
using signs::Link;
using signs::NodePlace;
using signs::Part;

namespace {

constexpr float kSliver = 1;        // [voxel], largest depth of a sliver component
constexpr float kOnSurface = 1e-6F; // [voxel]
constexpr std::int8_t kInside = -1; // signs of phi
constexpr std::int8_t kOutside = 1;
constexpr std::int8_t kPerNode = 2; // every node of the part has its own sign
constexpr float kUnknownVote = std::numeric_limits<float>::quiet_NaN();

bool isInsideByWinding(float w) {
  return std::abs(w) > 0.5F;
}

class Signer {
 public:
  Signer(FieldBuilder& builder, const TriangleMesh& mesh, const TriangleTree& tree,
         const WindingNumber& winding, const OpenParts& open, Progress& progress)
      : builder_(builder), mesh_(mesh), tree_(tree), winding_(winding), open_(open),
        progress_(progress), gap_(static_cast<float>(open.gap / builder.field.grid.voxel)) {}

  std::size_t run() {
    parts_ = signs::connectedComponents(builder_, signs::kMargin + gap_);
    sign_.assign(parts_.parts.size(), 0);
    vote_.assign(parts_.parts.size(), kUnknownVote);
    depth_.assign(parts_.parts.size(), 0);
    for (std::size_t i = 0; i < parts_.parts.size(); ++i)
      depth_[parts_.root[i]] = std::max(depth_[parts_.root[i]], parts_.parts[i].depth);
    signComponents();
    progress_.throwIfCancelled();
    signSlivers();
    progress_.throwIfCancelled();
    write();
    return ambiguous_;
  }

 private:
  struct Tally {
    std::size_t inside = 0, outside = 0; // nodes
    bool mixed() const { return inside > 0 && outside > 0; }
    std::int8_t majority() const { return inside > outside ? kInside : kOutside; }
  };

  Vec3 world(std::int32_t slot, std::size_t node) const {
    const std::array<int, 3> at = signs::nodeAt(builder_, slot, node);
    return builder_.field.grid.toWorld(Vec3(at[0], at[1], at[2]));
  }

  Vec3 centreOfBlock(std::size_t top_index) const {
    const auto nx = static_cast<std::size_t>(builder_.field.blocks[0]);
    const auto ny = static_cast<std::size_t>(builder_.field.blocks[1]);
    const Vec3 block(static_cast<double>(top_index % nx), static_cast<double>(top_index / nx % ny),
                     static_cast<double>(top_index / nx / ny));
    return builder_.field.grid.toWorld(kBlockSide * block + Vec3::Constant(0.5 * (kBlockSide - 1)));
  }

  bool isSliver(std::size_t part) const { return !(depth_[parts_.root[part]] > kSliver); }
  // A component can leak from a thin part between loose pieces, which still votes.
  bool reachesDeep(std::size_t part) const {
    constexpr float kLeast = 0.5F; // [voxel]
    const float depth = parts_.parts[part].depth;
    return 2 * depth >= depth_[parts_.root[part]] || (gap_ > 0 && depth >= kLeast);
  }
  bool isStored(std::size_t part) const { return parts_.parts[part].slot >= 0; }

  void vote(const std::vector<std::uint32_t>& voters) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, voters.size(), 32),
                      [&](const auto& range) {
                        for (std::size_t i = range.begin(); i < range.end(); ++i) {
                          const std::uint32_t part = voters[i];
                          const Part& p = parts_.parts[part];
                          vote_[part] = static_cast<float>(
                              winding_.at(p.slot >= 0 ? world(p.slot, p.deepest)
                                                      : centreOfBlock(part - parts_.first.back())));
                        }
                      });
  }

  std::vector<Tally> tallies() const {
    std::vector<Tally> tally(parts_.parts.size());
    for (std::size_t i = 0; i < parts_.parts.size(); ++i) {
      if (std::isnan(vote_[i])) continue;
      Tally& t = tally[parts_.root[i]];
      (isInsideByWinding(vote_[i]) ? t.inside : t.outside) += parts_.parts[i].nodes;
    }
    return tally;
  }

  // Only deep parts vote, because single faces have little weight there.
  void signComponents() {
    std::vector<std::uint32_t> voters;
    for (std::uint32_t i = 0; i < parts_.first.back(); ++i)
      if (!isSliver(i) && reachesDeep(i)) voters.push_back(i);
    vote(voters);
    for (std::uint32_t i : voters)
      if (isInsideByWinding(vote_[i])) outward_balance_ += vote_[i] > 0 ? 1 : -1;

    const std::vector<Tally> tally = tallies();
    bool mixed = false;
    for (std::size_t i = 0; i < sign_.size(); ++i) {
      if (isSliver(i)) continue;
      sign_[i] = tally[parts_.root[i]].majority();
      mixed = mixed || tally[parts_.root[i]].mixed();
    }
    countFaced(voters);
    if (!mixed) return;
    if (!signs::isClosed(mesh_, open_)) cutLeaks(tally);
    for (std::uint32_t i = 0; i < parts_.first.back(); ++i)
      if (!std::isnan(vote_[i]) && sign_[i] != kPerNode &&
          isInsideByWinding(vote_[i]) != (sign_[i] == kInside))
        ambiguous_ += parts_.parts[i].nodes;
  }

  // Counts nodes of outside components whose deepest nodes face backs as well as fronts of faces.
  void countFaced(const std::vector<std::uint32_t>& voters) {
    std::vector<Tally> seen(sign_.size()); // inside: behind the nearest face
    for (std::uint32_t i : voters) {
      if (sign_[i] == kInside || std::abs(vote_[i]) > 0.5F) continue;
      const double side = sideOfNearest(parts_.parts[i]);
      Tally& t = seen[parts_.root[i]];
      if (side < 0) t.inside += parts_.parts[i].nodes;
      if (side > 0) t.outside += parts_.parts[i].nodes;
    }
    for (const Tally& t : seen) ambiguous_ += std::min(t.inside, t.outside);
  }

  void cutLeaks(const std::vector<Tally>& tally) {
    std::vector<std::uint32_t> voters;
    std::vector<std::uint32_t> leaking;
    for (std::uint32_t i = 0; i < sign_.size(); ++i) {
      if (!tally[parts_.root[i]].mixed()) continue;
      leaking.push_back(i);
      if (std::isnan(vote_[i]) && (!isStored(i) || parts_.parts[i].depth > kSliver))
        voters.push_back(i);
    }
    vote(voters);
    std::vector<float> inside_confidence(sign_.size(), kUnknownVote);
    for (std::uint32_t i : leaking)
      inside_confidence[i] =
          std::isnan(vote_[i]) ? 0 : std::clamp(4 * (std::abs(vote_[i]) - 0.5F), -1.0F, 1.0F);
    signs::linkUnstored(builder_, parts_);
    const std::vector<std::int8_t> cut = signs::cutLeaks(parts_, inside_confidence);
    progress_.throwIfCancelled();
    for (std::uint32_t i : leaking) sign_[i] = cut[i];
    std::vector<bool> beside_cut(sign_.size());
    for (const Link& link : parts_.links)
      if (cut[link.a] != cut[link.b]) beside_cut[link.a] = beside_cut[link.b] = true;
    std::vector<std::int32_t> slots;
    for (std::uint32_t i : leaking) {
      if (!beside_cut[i] || !isStored(i)) continue;
      sign_[i] = kPerNode;
      if (slots.empty() || slots.back() != parts_.parts[i].slot)
        slots.push_back(parts_.parts[i].slot);
    }
    std::atomic<std::size_t> doubtful{0};
    tbb::parallel_for(std::size_t{0}, slots.size(), [&](std::size_t s) {
      const auto slot = static_cast<std::size_t>(slots[s]);
      auto phi = phiOf(builder_, slot);
      std::size_t here = 0;
      for (std::size_t n = 0; n < phi.size(); ++n) {
        if (sign_[parts_.partOf(slots[s], n)] != kPerNode || progress_.cancelled()) continue;
        const auto w = static_cast<float>(winding_.at(world(slots[s], n)));
        if (isInsideByWinding(w)) phi[n] = -phi[n];
        here += std::abs(std::abs(w) - 0.5F) < 0.25F;
      }
      setPhi(builder_, slot, phi);
      doubtful += here;
    });
    ambiguous_ += doubtful;
  }

  struct Sliver {
    std::uint32_t deepest = 0; // index of the part
    std::size_t nodes = 0;
    bool has_visible_node = false; // `seen` is visible and gives the sign
    NodePlace seen;
  };

  std::int8_t signAt(const NodePlace& place) const {
    if (place.slot < 0) return sign_[parts_.partOfBlock(place.top_index)];
    const std::uint32_t part = parts_.partOf(place.slot, place.node);
    if (isSliver(part)) return sign_[parts_.root[part]];
    if (sign_[part] != kPerNode) return sign_[part];
    const float phi = phiAt(builder_, place.slot, place.node);
    return std::signbit(phi) ? kInside : kOutside;
  }

  std::vector<Sliver> slivers() {
    std::vector<Sliver> result;
    sliver_of_.resize(sign_.size());
    for (std::uint32_t i = 0; i < parts_.first.back(); ++i) {
      if (!isSliver(i)) continue;
      const std::uint32_t root = parts_.root[i];
      if (root == i) {
        sliver_of_[i] = static_cast<std::uint32_t>(result.size());
        result.push_back({i, 0, false, {}});
      }
      Sliver& sliver = result[sliver_of_[root]];
      sliver.nodes += parts_.parts[i].nodes;
      if (parts_.parts[i].depth > parts_.parts[sliver.deepest].depth) sliver.deepest = i;
    }
    return result;
  }

  // A sliver may see another one, but only a deeper one, so that the chain ends.
  std::int8_t signOf(const Sliver& sliver, const std::vector<Sliver>& all,
                     const std::vector<Tally>& tally) {
    const std::uint32_t root = parts_.root[sliver.deepest];
    if (sign_[root] != 0) return sign_[root];
    if (sliver.has_visible_node) {
      if (sliver.seen.slot >= 0) {
        const std::uint32_t part = parts_.partOf(sliver.seen.slot, sliver.seen.node);
        if (isSliver(part)) signOf(all[sliver_of_[parts_.root[part]]], all, tally);
      }
      sign_[root] = signAt(sliver.seen);
    } else if (parts_.parts[sliver.deepest].depth > kOnSurface) {
      sign_[root] = tally[root].majority();
      ambiguous_ += std::min(tally[root].inside, tally[root].outside);
    } else {
      sign_[root] = kOutside;
    }
    if (conflictsWithFace(sliver, sign_[root])) ambiguous_ += sliver.nodes;
    return sign_[root];
  }

  void signSlivers() {
    std::vector<Sliver> all = slivers();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, all.size(), 64), [&](const auto& range) {
      signs::NearbyBlocks blocks(builder_);
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        const Part& part = parts_.parts[all[i].deepest];
        all[i].has_visible_node = part.depth > kOnSurface &&
                                  signs::visibleDeeperNode(blocks, tree_, part.slot, part.deepest,
                                                           all[i].seen, signs::kExact + gap_);
      }
    });
    progress_.throwIfCancelled();
    std::vector<bool> blind(sign_.size());
    for (const Sliver& sliver : all)
      if (!sliver.has_visible_node && parts_.parts[sliver.deepest].depth > kOnSurface)
        blind[parts_.root[sliver.deepest]] = true;
    std::vector<std::uint32_t> voters;
    for (std::uint32_t i = 0; i < parts_.first.back(); ++i)
      if (blind[parts_.root[i]] && parts_.parts[i].depth >= 0.7F * depth_[parts_.root[i]])
        voters.push_back(i);
    vote(voters);
    std::vector<Tally> tally(voters.empty() ? std::vector<Tally>() : tallies());
    for (const Sliver& sliver : all) signOf(sliver, all, tally);
    for (std::uint32_t i = 0; i < parts_.first.back(); ++i)
      if (isSliver(i)) sign_[i] = sign_[parts_.root[i]];
  }

  // Returns the side of the nearest face at the deepest node: > 0 in front of it, 0 if it has the
  // sign of `wanted` or the nearest point is not in the face's interior.
  double sideOfNearest(const Part& part, double wanted = 0) const {
    const std::int32_t face = builder_.face[static_cast<std::size_t>(part.slot)]->at(part.deepest);
    if (face < 0) return 0;
    const auto f = static_cast<std::size_t>(face);
    if (open_.any() && open_.open[f]) return 0;
    const Vec3 a = mesh_.corner(f, 0), b = mesh_.corner(f, 1), c = mesh_.corner(f, 2);
    const Vec3 p = world(part.slot, part.deepest);
    const double side = (b - a).cross(c - a).dot(p - a);
    return side * wanted > 0 || closestBarycentric(p, a, b, c).minCoeff() < 1e-3 ? 0 : side;
  }

  // Returns true if the nearest face has the other sign.
  bool conflictsWithFace(const Sliver& sliver, std::int8_t sign) const {
    const Part& part = parts_.parts[sliver.deepest];
    if (outward_balance_ == 0 || part.depth < 1e-2F) return false;
    const int wanted = (outward_balance_ > 0 ? 1 : -1) * sign;
    return sideOfNearest(part, wanted) != 0;
  }

  void write() {
    SurfaceField& field = builder_.field;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, builder_.distance.size(), 16),
                      [&](const auto& range) {
                        for (std::size_t s = range.begin(); s < range.end(); ++s) writeBlock(s);
                      });
    for (std::size_t i = 0; i < field.block_index.size(); ++i)
      if (field.block_index[i] < 0)
        field.block_index[i] = sign_[parts_.partOfBlock(i)] == kInside ? SurfaceField::kInside
                                                                       : SurfaceField::kOutside;
  }

  void writeBlock(std::size_t slot) {
    auto phi = phiOf(builder_, slot);
    const std::uint32_t first = parts_.first[slot];
    const signs::Labels* labels = parts_.labels[slot].get();
    for (std::size_t n = 0; n < phi.size(); ++n)
      if (sign_[first + (labels ? (*labels)[n] : 0U)] == kInside) phi[n] = -phi[n];
    for (float& value : phi)
      if (std::abs(value) <= kOnSurface) value = std::abs(value);
    setPhi(builder_, slot, phi);
  }

  FieldBuilder& builder_;
  const TriangleMesh& mesh_;
  const TriangleTree& tree_;
  const WindingNumber& winding_;
  const OpenParts& open_;
  Progress& progress_;
  // Width of the gaps between loose pieces [voxel], 0 without such. The nodes of an edge through a
  // gap are no farther from the surface in sum than its length and this.
  const float gap_;
  Components parts_;
  std::vector<float> depth_;             // depth of each component, at its root
  std::vector<float> vote_;              // winding number at each part's deepest node
  std::vector<std::int8_t> sign_;        // sign of each part
  std::vector<std::uint32_t> sliver_of_; // sliver of each root
  std::ptrdiff_t outward_balance_ = 0;   // > 0: most faces are oriented outward
  std::size_t ambiguous_ = 0;
};

// Signs the nodes closest to an open part.
void signSheets(FieldBuilder& builder, const TriangleMesh& mesh, const OpenParts& open,
                double thickness) {
  const PseudonormalSide front(mesh, open.open, open.seams);
  tbb::parallel_for(std::size_t{0}, builder.distance.size(), [&](std::size_t slot) {
    auto phi = phiOf(builder, slot);
    for (std::size_t n = 0; n < phi.size(); ++n) {
      const std::int32_t face = builder.face[slot]->at(n);
      if (face < 0 || !open.open[static_cast<std::size_t>(face)]) continue;
      if (!(phi[n] > kOnSurface) || !(static_cast<double>(phi[n]) < thickness)) continue;
      const std::array<int, 3> at = signs::nodeAt(builder, static_cast<std::int32_t>(slot), n);
      const Vec3 p = builder.field.grid.toWorld(Vec3(at[0], at[1], at[2]));
      if (front.at(p, face) == Side::back) phi[n] = -phi[n];
    }
    setPhi(builder, slot, phi);
  });
}

} // namespace

void signCoarse(FieldBuilder& builder) {
  SurfaceField& field = builder.field;
  const auto& n = field.blocks;
  std::size_t corner = 0;
  for (int z = 0; z <= n[2]; ++z) {
    for (int y = 0; y <= n[1]; ++y) {
      for (int x = 0; x <= n[0]; ++x, ++corner) {
        // The last layer lies beyond the grid and thus outside.
        if (field.coarse.empty() || x == n[0] || y == n[1] || z == n[2]) continue;
        const std::int32_t slot = field.slotOf(x, y, z);
        const bool inside = slot >= 0 ? phiAt(builder, slot, 0) < 0 : slot == SurfaceField::kInside;
        if (!inside) continue;
        CoarseNode& node = field.coarse[corner];
        node = {-node.phi, -node.gx, -node.gy, -node.gz};
      }
    }
  }
}

std::size_t assignSigns(FieldBuilder& builder, const TriangleMesh& mesh, const TriangleTree& tree,
                        const WindingNumber& winding, const OpenParts& open, double thickness,
                        Progress& progress) {
  std::size_t ambiguous = 0;
  if (open.triangles < mesh.triangles.size())
    ambiguous = Signer(builder, mesh, tree, winding, open, progress).run();
  progress.throwIfCancelled();
  if (open.any() && thickness > 0) signSheets(builder, mesh, open, thickness);
  return ambiguous;
}

} // namespace patina
