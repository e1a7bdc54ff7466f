// Image (K16, K18) and material map (K22) of an object under the brush, during a stroke.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "authoring/brush/dab.h"
#include "authoring/brush/paint_surface.h"

namespace patina {

// Material map of an object under the brush, during a stroke (K22).

// Value that the brush composites into one channel.
struct MaterialInk {
  MaterialChannel channel;
  double value = 0; // SI
};

class MaterialStroke {
 public:
  // start: the map before the stroke; null = unpainted, and the nodes will coincide with the
  // field's (in the object's present pose). base: unpainted values. inks: of the channels to
  // change; erase changes all.
  MaterialStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
                 std::shared_ptr<const MaterialMap> start, const Material& base,
                 std::vector<MaterialInk> inks);

  std::size_t paint(const Dab& dab, const Brush& brush); // returns the number of covered nodes

  bool changed() const { return changed_; }  // since the last take()
  std::shared_ptr<const MaterialMap> take(); // see ImageStroke
  void dropEmpty();
  std::vector<MaterialMap::Index> takeBlocks(); // written since the last call, ascending

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
  bool looksAway(const Vec3& place, const Vec3& front) const;
  Vec3 placeOf(const Index& block, std::size_t node) const; // object frame
  Pair pairAt(const std::array<std::int32_t, 3>& node, MaterialChannel channel) const;
  void set(const Index& block, std::size_t node, MaterialChannel channel, const Pair& pair);
  std::size_t composite(const Dab& local, const Brush& brush);
  std::size_t smooth(const Dab& local, const Brush& brush);

  std::shared_ptr<const PaintSurface> surface_;
  Pose world_from_object_;
  MaterialMap start_, map_;
  Material base_;
  std::vector<MaterialInk> inks_;
  std::map<Index, Weights> weights_; // largest weights of the stroke so far
  bool changed_ = false;
  std::set<Index> written_;
};

// Value to composite: colour premultiplied with coverage 1, or relief value.
struct Ink {
  std::array<double, 4> value{};
  bool erases = false;
};

class ImageStroke {
 public:
  // start: the image before the stroke; null = unpainted. The surface has images.
  ImageStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
              std::shared_ptr<const TiledImage> start, int channels, const Ink& ink);

  // faces: this object's, in the combined mesh. Returns the number of texels that the brush covers.
  std::size_t paint(const Dab& dab, const Brush& brush, std::span<const std::int32_t> faces);

  bool changed() const { return changed_; } // since the last take()
  // Returns the current image, or null if unpainted. It does not change later: painting on copies
  // the tiles it writes.
  std::shared_ptr<const TiledImage> take();
  void dropEmpty();
  bool takeWritten(); // true if a texel was written since the last call

 private:
  struct Texel {
    std::size_t tile, offset; // index in the image's values
  };
  Texel texelAt(int i, int j) const;
  void composite(const Texel& texel, double weight, StrokeMode mode);
  void set(const Texel& texel, const std::array<double, 4>& values);
  std::array<double, 4> valuesIn(const TiledImage* image, const Texel& texel) const;
  std::size_t smooth(const Dab& dab, const Brush& brush, std::span<const std::int32_t> faces);

  std::shared_ptr<const PaintSurface> surface_;
  const PaintObject* object_;
  std::shared_ptr<const TiledImage> start_;
  TiledImage image_;
  TiledImage weights_; // largest weights of the stroke so far
  Ink ink_;
  bool changed_ = false;
  bool written_ = false;
};

} // namespace patina
