// Painted material: values at the nodes of a sparse grid of one object (K22).
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <set>

#include "core/types.h"
#include "field/store/block_node.h"
#include "scene/paint/channels.h"
#include "scene/paint/unique_flags.h"

namespace patina {

inline constexpr int kMaterialSide = kBlockSide; // nodes
inline constexpr std::size_t kMaterialNodes = kBlockNodes;

// Paint over the object's own value: a node's value is value + (1 - weight) * base, so that a
// change of the base shows wherever paint does not cover it (K18). Unpainted: 0, 0.
struct MaterialLayer {
  std::array<float, kMaterialNodes> value{}, weight{}; // x fastest
};
// Returns paint composited over the base `own` (Porter & Duff 1984). Clamped to the channel's
// range, because a value added to a base that was reduced later could be negative, and negative
// stiffness drives the hand.
double compositedAt(const MaterialLayer& layer, std::size_t node, double own,
                    const MaterialRange& range);

struct MaterialBlock {
  std::array<std::shared_ptr<MaterialLayer>, kMaterialChannels> layer; // null = unpainted
};

// Node (i, j, k) lies at origin + voxel * (i, j, k) in the object's own frame; block (b) holds
// nodes 8 b .. 8 b + 7. Copies share layers; writable() copies a shared one.
class MaterialMap {
 public:
  using Index = Index3;

  MaterialMap(const Vec3& origin,
              double voxel); // finite, > 0

  const Vec3& origin() const { return origin_; } // [m], object frame
  double voxel() const { return voxel_; }        // [m]
  const std::map<Index, MaterialBlock>& blocks() const { return blocks_; }
  const MaterialLayer* layer(const Index& block, MaterialChannel channel) const;
  MaterialLayer& writable(const Index& block, MaterialChannel channel);
  MaterialMap published();                 // copy for other threads
  bool has(MaterialChannel channel) const; // anywhere
  void dropEmptyLayers();                  // removes layers that are 0 everywhere
  std::size_t bytes() const;

  // Returns the trilinear interpolant of the composited nodes at p [m, object frame] (K23).
  Material at(const Vec3& p, const Material& base) const;
  // The paint itself at a point, trilinear; 0, 0 where unpainted.
  struct Paint {
    double value = 0, weight = 0;
  };
  Paint paintAt(const Vec3& p, MaterialChannel channel) const;

 private:
  template <typename Visit> void forCorners(const Vec3& p, const Visit& visit) const;

  Vec3 origin_;
  double voxel_;
  std::map<Index, MaterialBlock> blocks_;
  UniqueFlags<std::set<const MaterialLayer*>> own_;
};

bool same(const MaterialMap& a, const MaterialMap& b); // bitwise; a missing layer equals zeros

} // namespace patina
