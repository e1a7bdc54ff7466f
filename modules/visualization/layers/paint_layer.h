// What was painted, on the surface: colour, relief and material as felt (K16, K21, K23).
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

// Objects that have nothing painted of what is shown are not drawn here and cost nothing. UI
// thread. Images become textures; material becomes values at the points of a surface about as
// fine as the material's grid, so that a plate of two triangles shows it too, and a change of range
// costs nothing.
class PaintLayer {
 public:
  // scene: where the surfaces are; overlay: where the scalar bar is.
  PaintLayer(vtkRenderer& scene, vtkRenderer& overlay);
  ~PaintLayer();
  PaintLayer(const PaintLayer&) = delete;
  PaintLayer& operator=(const PaintLayer&) = delete;

  // The scene as it is now, after every edit and every dab: what changed is found by comparing
  // pointers of objects, tiles and blocks, and drawn by the next prepare(), once for any number of
  // calls. `texels`: maps that exist already, one an object or none; what is missing is made when
  // relief is drawn.
  void set(const Scene& scene, const std::vector<std::shared_ptr<const TexelMap>>& texels = {});

  void show(std::optional<PaintQuantity> quantity); // nullopt: nothing
  // Whether there is anything of it to see, and whether an object is drawn here and not elsewhere.
  bool has(PaintQuantity quantity) const;
  bool draws(std::size_t object) const;

  // nullopt: what is painted and the scene's own value, rounded, widened as painting goes on.
  void lockRange(PaintQuantity quantity, std::optional<ValueRange> range);
  bool locked(PaintQuantity quantity) const;
  ValueRange range(PaintQuantity quantity) const; // as shown, after prepare()
  vtkLookupTable* colors() const; // of what is shown, in SI, after prepare(); nullptr for colour

  void setVisible(bool on); // surfaces and bar
  // Brings textures and values up to date with what was given. Before a render.
  void prepare();
  void setWireframe(bool on);
  void setCuts(vtkPlaneCollection* planes); // of its surfaces; nullptr: none
  vtkScalarBarActor& bar();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
