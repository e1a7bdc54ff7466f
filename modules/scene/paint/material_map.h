// Material that a person painted: values at the nodes of a sparse grid of one object (K22).
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <set>

#include "core/types.h"
#include "field/store/block_node.h"
#include "scene/paint/channels.h"
#include "scene/paint/own_parts.h"

namespace patina {

inline constexpr int kMaterialSide = kBlockSide; // nodes
inline constexpr std::size_t kMaterialNodes = kBlockNodes;

// Paint over the object's own value: what is felt at a node is value + (1 - weight) * base, so that
// a change of the base is felt wherever paint does not cover it (K18). Nothing painted: 0, 0.
struct MaterialLayer {
  std::array<float, kMaterialNodes> value{}, weight{}; // x fastest
};
// What is felt at a node over the base `own`. Held within the channel's range: what was added to a
// base that has become smaller since must not lead below it (a stiffness below 0 drives the hand).
double feltAt(const MaterialLayer& layer, std::size_t node, double own, const MaterialRange& range);

struct MaterialBlock {
  std::array<std::shared_ptr<MaterialLayer>, kMaterialChannels> layer; // absent = nothing painted
};

// Node (i, j, k) lies at origin + voxel * (i, j, k) in the object's own frame; block (b) holds
// nodes 8 b .. 8 b + 7. Copies share layers; writable() copies the one that is shared.
class MaterialMap {
 public:
  using Index = Index3;

  MaterialMap(const Vec3& origin, double voxel); // invalid_argument unless finite and voxel > 0

  const Vec3& origin() const { return origin_; } // [m], object frame
  double voxel() const { return voxel_; }        // [m]
  const std::map<Index, MaterialBlock>& blocks() const { return blocks_; }
  const MaterialLayer* layer(const Index& block, MaterialChannel channel) const;
  MaterialLayer& writable(const Index& block, MaterialChannel channel);
  MaterialMap published();                 // a copy for others
  bool has(MaterialChannel channel) const; // anywhere
  void dropEmptyLayers();                  // those that are 0 everywhere
  std::size_t bytes() const;

  // Trilinear in what is felt at the nodes, at p [m, object frame] (K23).
  Material at(const Vec3& p, const Material& base) const;
  // The paint itself there, trilinear; 0, 0 where nothing is painted.
  struct Paint {
    double value = 0, weight = 0;
  };
  Paint paintAt(const Vec3& p, MaterialChannel channel) const;

 private:
  template <typename Visit> void forCorners(const Vec3& p, const Visit& visit) const;

  Vec3 origin_;
  double voxel_;
  std::map<Index, MaterialBlock> blocks_;
  OwnParts<std::set<const MaterialLayer*>> own_;
};

bool same(const MaterialMap& a, const MaterialMap& b); // bitwise; absent equals zeros

} // namespace patina
