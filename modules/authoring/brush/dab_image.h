// One image of an object under the brush, for the length of a stroke (K16, K18).
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "authoring/brush/dab.h"
#include "authoring/brush/paint_surface.h"

namespace patina {

// What the brush lays on: colour premultiplied with coverage 1, or g.
struct Ink {
  std::array<double, 4> value{};
  bool erases = false;
};

class ImageStroke {
 public:
  // start: as it is before the stroke; null = nothing painted yet. The surface has images.
  ImageStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
              std::shared_ptr<const TiledImage> start, int channels, const Ink& ink);

  // Faces of the joint mesh, this object's. Returns the texels that the brush covers.
  std::size_t paint(const Dab& dab, const Brush& brush, std::span<const std::int32_t> faces);

  bool changed() const { return changed_; } // since the last take()
  // As it is now; null if nothing is painted. Never changes later: painting on copies what it
  // touches.
  std::shared_ptr<const TiledImage> take();
  void dropEmpty();
  std::vector<std::size_t> takeTiles(); // written since the last call, ascending
  Box3 takeRegion();                    // world: of the surface that shows what was written

 private:
  struct Texel {
    std::size_t tile, offset; // in values of the image
    Vec3 point;
    double footprint;
  };
  Texel texelAt(int i, int j, const Vec3& point, double footprint) const;
  void lay(const Texel& texel, double weight, StrokeMode mode);
  void set(const Texel& texel, const std::array<double, 4>& values);
  std::array<double, 4> valuesIn(const TiledImage* image, const Texel& texel) const;
  std::size_t smooth(const Dab& dab, const Brush& brush, std::span<const std::int32_t> faces);

  std::shared_ptr<const PaintSurface> surface_;
  const PaintObject* object_;
  std::shared_ptr<const TiledImage> start_;
  TiledImage image_;
  TiledImage weights_; // the stroke's greatest so far
  Ink ink_;
  bool changed_ = false;
  std::vector<bool> written_; // by tile
  Box3 region_;
};

} // namespace patina
