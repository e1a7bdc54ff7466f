// An object's material map under the brush, for the length of a stroke (K22).
#pragma once

#include <map>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "authoring/brush/dab.h"
#include "authoring/brush/paint_surface.h"

namespace patina {

// What the brush lays on one channel.
struct MaterialInk {
  MaterialChannel channel;
  double value = 0; // SI
};

class MaterialStroke {
 public:
  // start: as it is before the stroke; null = nothing painted yet, and the nodes will lie where the
  // field's do (as the object stands now). base: what is felt without paint. inks: of the channels
  // that the brush works on; with tool erase it takes away from all of them.
  MaterialStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
                 std::shared_ptr<const MaterialMap> start, const Material& base,
                 std::vector<MaterialInk> inks);

  std::size_t paint(const Dab& dab, const Brush& brush); // returns the nodes that it covers

  bool changed() const { return changed_; }  // since the last take()
  std::shared_ptr<const MaterialMap> take(); // as ImageStroke's
  void dropEmpty();
  std::vector<MaterialMap::Index> takeBlocks(); // written since the last call, ascending
  Box3 takeRegion();                            // world, of the nodes that were written

 private:
  using Index = MaterialMap::Index;
  using Weights = std::array<float, kMaterialNodes>;
  struct Pair {
    double value = 0, weight = 0;
  };

  template <typename Visit> void forBlocks(const Dab& local, const Visit& visit) const;
  template <typename Visit>
  void forNodes(const Dab& local, const Brush& brush, const Index& block, const Visit& visit) const;
  bool isNearSurface(const Index& block) const;
  bool looksAway(const Vec3& place, const Vec3& front) const; // the side that a node belongs to
  Vec3 placeOf(const Index& block, std::size_t node) const;   // object frame
  Pair pairAt(const std::array<std::int32_t, 3>& node, MaterialChannel channel) const;
  void set(const Index& block, std::size_t node, MaterialChannel channel, const Pair& pair);
  std::size_t lay(const Dab& local, const Brush& brush);
  std::size_t smooth(const Dab& local, const Brush& brush);

  std::shared_ptr<const PaintSurface> surface_;
  Pose world_from_object_;
  MaterialMap start_, map_;
  Material base_;
  std::vector<MaterialInk> inks_;
  std::map<Index, Weights> weights_; // the stroke's greatest so far
  bool changed_ = false;
  std::set<Index> written_;
  Box3 region_;
};

} // namespace patina
