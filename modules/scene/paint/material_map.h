// Material that a person painted: values at the nodes of a sparse grid of one object (K22).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string_view>

#include "core/types.h"
#include "field/store/block_node.h"
#include "scene/paint/own_parts.h"

namespace patina {

// What a contact is made of at one point. SI.
struct Material {
  double stiffness = 500;      // K [N/m]
  double static_friction = 0;  // mu_s
  double dynamic_friction = 0; // mu_d
  double damping = 0;          // B [N s/m]
  double roughness = 0;        // [m], rms height of a fine pattern
  bool operator==(const Material&) const = default;
};

enum class MaterialChannel : std::uint8_t {
  stiffness,
  static_friction,
  dynamic_friction,
  damping,
  roughness
};
inline constexpr std::size_t kMaterialChannels = 5;
inline constexpr std::array<MaterialChannel, kMaterialChannels> kAllMaterialChannels{
    MaterialChannel::stiffness, MaterialChannel::static_friction, MaterialChannel::dynamic_friction,
    MaterialChannel::damping, MaterialChannel::roughness};

std::string_view name(MaterialChannel channel); // "stiffness", "friction.static", ...
std::string_view unit(MaterialChannel channel); // "N/m", "" ...
double& valueOf(Material& material, MaterialChannel channel);
double valueOf(const Material& material, MaterialChannel channel);
// What a scene allows for it, as validate() of scene.h: 0 or more.
struct MaterialRange {
  double least, most;
};
MaterialRange rangeOf(MaterialChannel channel);

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
