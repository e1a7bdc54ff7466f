// Draws paint on the surface: colour, relief and rendered material (K16, K21, K23).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <vtkPlaneCollection.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>

#include "geometry/atlas/texel_map.h"
#include "scene/scene.h"
#include "visualization/values/paint_quantity.h"

namespace patina {

// Objects without the shown kind of paint are not drawn here and cost nothing. Images become
// textures. Material becomes values on a surface about as fine as the material's grid, so that a
// plate of two triangles shows it too, and a change of range costs nothing. UI thread.
class PaintLayer {
 public:
  // scene: renderer of the surfaces; overlay: renderer of the scalar bar.
  PaintLayer(vtkRenderer& scene, vtkRenderer& overlay);
  ~PaintLayer();
  PaintLayer(const PaintLayer&) = delete;
  PaintLayer& operator=(const PaintLayer&) = delete;

  // Sets the scene after an edit or a dab. The next prepare() compares pointers of objects, tiles
  // and blocks and draws the changes, once for any number of calls. `texels`: existing texel maps,
  // one per object or none; missing ones are made when relief is drawn.
  void set(const Scene& scene, const std::vector<std::shared_ptr<const TexelMap>>& texels = {});

  void show(std::optional<PaintQuantity> quantity); // nullopt: nothing
  // Whether any object has this paint, and whether this layer draws an object instead of the mesh.
  bool has(PaintQuantity quantity) const;
  bool draws(std::size_t object) const;

  // The default range is that of the paint and the scene's base value, rounded, which grows while
  // painting.
  void setScale(PaintQuantity quantity, const ColorScale& scale);
  ValueRange range(PaintQuantity quantity) const; // range drawn by prepare()
  // of the shown quantity, in SI, after prepare(); nullptr for colour
  vtkLookupTable* colors() const;

  void setVisible(bool on); // surfaces and bar
  // Updates textures and values. Call before a render.
  void prepare();
  void setWireframe(bool on);
  void setCuts(vtkPlaneCollection* planes); // clip planes of its surfaces; nullptr: none
  vtkScalarBarActor& bar();

 private:
  struct Impl;
  std::unique_ptr<Impl> my_;
};

} // namespace patina
