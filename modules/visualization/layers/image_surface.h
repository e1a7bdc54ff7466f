// Draws an object's painted images as textures, or its material on a surface as fine as its grid.
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
#include "visualization/values/scene_setup.h"

namespace patina {

// Draws an object's rendered material on a surface as fine as its grid (K22, K23).

// Boxes, in the map's frame, where values of the channel may have changed, found by comparing
// layers by pointer; nullopt: anywhere.
std::optional<std::vector<Box3>> changedPlaces(const MaterialMap* before, const MaterialMap& now,
                                               MaterialChannel channel);

class MaterialSurface {
 public:
  MaterialSurface();

  void set(const SceneObject& object, const Material& base);

  // Evaluates changed values; returns the range of all values with the base.
  ValueRange prepare(MaterialChannel channel);
  std::vector<float> values() const; // drawn values, after prepare()
  void setColors(vtkLookupTable* colors) { mapperOf(*actor_).SetLookupTable(colors); }
  vtkActor& actor() { return *actor_; }

 private:
  void evaluate(MaterialChannel channel, const std::vector<Box3>* places);

  std::shared_ptr<const TriangleMesh> mesh_;
  std::shared_ptr<const MaterialMap> map_;
  Material base_;

  std::shared_ptr<const MaterialMap> shown_; // map of the drawn values
  std::optional<MaterialChannel> channel_;
  double shown_base_ = 0;
  double fineness_ = 0; // voxel that the points were made for [m]
  ValueRange range_;

  std::vector<Vec3> points_; // vertices of the drawn surface, object frame
  vtkSmartPointer<vtkActor> actor_;
};

// Tiles that differ, compared by pointer; all tiles of `now` if `before` is null.
std::vector<std::size_t> changedTiles(const TiledImage* before, const TiledImage& now);

class ImageSurface {
 public:
  ImageSurface();

  // Sets the object with its paint, which has an image and a layout; height: relief.height [m]. If
  // `texels` is null, a map is made when relief is first drawn.
  void set(const SceneObject& object, double height, std::shared_ptr<const TexelMap> texels);

  // Min and max painted height so far [m], including 0. Examines only new tiles.
  ValueRange heights();
  // Draws the tiles that changed, as colour or as relief in these colours; both shade the relief.
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

  // Images of the present textures and range, for comparing tiles.
  Image ink_image_, slope_image_, height_image_;
  PaintQuantity ink_of_ = PaintQuantity::color;
  double ink_height_ = 0, slope_height_ = 0;
  vtkMTimeType colors_time_ = 0;
  double least_ = 0, most_ = 0; // relief values

  vtkSmartPointer<vtkActor> actor_;
  vtkSmartPointer<vtkImageData> ink_, slope_;
  vtkSmartPointer<vtkTexture> ink_texture_, slope_texture_;
};

} // namespace patina
