// One object with its painted images as textures.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <vtkActor.h>
#include <vtkImageData.h>
#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>
#include <vtkTexture.h>

#include "geometry/atlas/texel_map.h"
#include "scene/scene.h"
#include "visualization/values/paint_quantity.h"

namespace patina {

// Tiles that are not the same, by pointer; all of `now` if there is nothing to compare.
std::vector<std::size_t> changedTiles(const TiledImage* before, const TiledImage& now);

class ImageSurface {
 public:
  ImageSurface();

  // The object as it is now, with its paint, which has an image and with it a layout; relief.height
  // [m]. `texels` may be null: a map is made when relief is first drawn.
  void set(const SceneObject& object, double height, std::shared_ptr<const TexelMap> texels);

  // Least and greatest painted height so far [m], 0 included. Looks at tiles it has not seen.
  ValueRange heights();
  // color, or relief in these colours. Draws only tiles that changed; relief is shaded in both.
  void prepare(PaintQuantity quantity, vtkLookupTable* colors);
  vtkActor& actor() { return *actor_; }

 private:
  using Image = std::shared_ptr<const TiledImage>;
  void drawInk(PaintQuantity quantity, vtkLookupTable* colors);
  void drawSlope();

  std::shared_ptr<const TriangleMesh> mesh_;
  std::shared_ptr<const CornerUvs> uvs_;
  std::shared_ptr<const TexelMap> texels_;
  std::shared_ptr<const ObjectPaint> paint_;
  double height_ = 0;

  // What textures and range show; kept so that tiles can be compared.
  Image ink_image_, slope_image_, height_image_;
  PaintQuantity ink_of_ = PaintQuantity::color;
  double ink_height_ = 0, slope_height_ = 0;
  vtkMTimeType colors_time_ = 0;
  double least_ = 0, most_ = 0; // of g

  vtkSmartPointer<vtkActor> actor_;
  vtkSmartPointer<vtkImageData> ink_, slope_;
  vtkSmartPointer<vtkTexture> ink_texture_, slope_texture_;
};

} // namespace patina
