// What was painted, on the surface: colour, relief and material as felt (K16, K21, K23).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <vtkPlane.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>

#include "geometry/texel_map.h"
#include "scene/scene.h"
#include "visualization/paint_quantity.h"

namespace patina {

// What changed of one object's paint since it was last given.
struct PaintPatch {
  std::size_t object = 0;
  std::vector<std::size_t> color_tiles, relief_tiles; // of its images
  std::vector<MaterialMap::Index> material_blocks;
};

// Objects that have nothing painted of what is shown are not drawn here and cost nothing. UI
// thread. Images become textures; material becomes values at the points of a surface that is as
// fine as the material's grid, so that a plate of two triangles shows it too, and a change of range
// costs nothing.
class PaintLayer {
 public:
  // scene: where the surfaces are; overlay: where the scalar bar is.
  PaintLayer(vtkRenderer& scene, vtkRenderer& overlay);
  ~PaintLayer();
  PaintLayer(const PaintLayer&) = delete;
  PaintLayer& operator=(const PaintLayer&) = delete;

  // Everything anew, at the next prepare(): objects, poses, values of the scene. What did not
  // change (the same pointers) is kept. `texels`: maps that exist already, one an object or none;
  // what is missing is made when relief is drawn.
  void set(const Scene& scene, std::vector<std::shared_ptr<const TexelMap>> texels = {});
  // Only paint changed, and only where the patches say. Cheap: work is done in prepare(), once for
  // any number of patches.
  void update(const Scene& scene, const std::vector<PaintPatch>& patches);

  void show(std::optional<PaintQuantity> quantity); // nullopt: nothing
  // Whether there is anything of it to see, and whether an object is drawn here and not elsewhere.
  bool has(PaintQuantity quantity) const;
  bool draws(std::size_t object) const;

  // nullopt: what is painted, felt values and the scene's own, widened as painting goes on.
  void lockRange(PaintQuantity quantity, std::optional<ValueRange> range);
  bool locked(PaintQuantity quantity) const;
  ValueRange range(PaintQuantity quantity) const; // as shown, after prepare()
  // What is painted by itself, e.g. for a slice through it; nullptr for colour.
  vtkLookupTable* colors() const;

  void setVisible(bool on); // surfaces and bar
  // Brings textures and values up to date with what was given. Before a render.
  void prepare();
  void setTextSize(int pixels);
  void setWireframe(bool on);
  void setClippingPlane(vtkPlane* plane); // nullptr: none
  vtkScalarBarActor& bar();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
