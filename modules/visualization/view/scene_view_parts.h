// What SceneView holds: its layers, what they show, and what is out of date.
#pragma once

#include <array>
#include <future>
#include <optional>

#include <vtkActor.h>
#include <vtkOutlineSource.h>
#include <vtkPlaneCollection.h>

#include "visualization/layers/band_layer.h"
#include "visualization/layers/brush_cursor.h"
#include "visualization/layers/node_layer.h"
#include "visualization/layers/paint_layer.h"
#include "visualization/layers/scale_layer.h"
#include "visualization/layers/slice_layer.h"
#include "visualization/layers/stability_layer.h"
#include "visualization/layers/tool_layer.h"
#include "visualization/layers/view_cube.h"
#include "visualization/values/palette.h"
#include "visualization/view/camera.h"
#include "visualization/view/half_size_pass.h"
#include "visualization/view/scene_furniture.h"
#include "visualization/view/scene_view.h"

namespace patina {

struct SceneView::Impl {
  vtkNew<vtkRenderer> scene, overlay, corner;
  vtkSmartPointer<vtkAxesActor> axes = axesActor();
  std::optional<ViewCube> cube; // in their place
  HotPart hot;
  palette::Ground ground = palette::kLight;
  vtkSmartPointer<vtkActor> mesh_actor = surfaceActor(palette::kSurface);
  vtkSmartPointer<vtkActor> iso_actor = surfaceActor(palette::kIso);
  vtkSmartPointer<vtkActor> coarse_actor = surfaceActor(palette::kSurface); // while it moves
  std::future<vtkSmartPointer<vtkPolyData>> coarse_made;                    // on its way
  bool has_coarse = false, moving = false;
  vtkNew<HalfSizePass> half_size; // while it moves
  vtkNew<vtkOutlineSource> outline;
  vtkNew<vtkActor> extent_actor;
  SliceLayer slice{*scene, *overlay};
  BandLayer band_layer{*scene, *overlay};
  StabilityLayer stability{*scene, *overlay};
  ToolLayer tool{*scene, *overlay};
  NodeLayer nodes{*overlay};
  PaintLayer paint{*scene, *overlay};
  BrushCursor brush{*overlay};
  ScaleLayer scale{*overlay};
  std::optional<ClipLayer> clip;
  std::optional<MirrorLayer> mirror;
  std::optional<MirrorPlace> mirror_place;

  std::shared_ptr<const TriangleMesh> mesh;
  Scene painted; // no objects where nothing is painted or the mesh is not theirs
  std::vector<std::shared_ptr<const TexelMap>> texels; // of these objects, or nothing
  std::vector<bool> left_out; // objects that the mesh's actor does not draw
  std::shared_ptr<const SurfaceField> field;
  double iso = 0;
  SlicePlace place;
  std::optional<TouchBand> band;
  std::optional<ToolSample> sample;
  std::set<Layer> layers{Layer::mesh, Layer::color, Layer::band, Layer::tip};
  std::optional<BrushPlace> brush_place;

  // What is out of date; made again by prepare() and only if it is shown.
  bool iso_stale = false, slice_stale = false, band_stale = false, nodes_stale = false;
  bool paint_stale = false, brush_stale = false;
  bool dirty = true, has_stability = false;
  bool cut_keeps_positive = true;
  std::vector<vtkPlane*> cut_by; // the surfaces are
  CameraPlace drawn_from{};
  std::array<int, 2> drawn_size{}; // bars and axes are placed by it

  Box3 mesh_box; // empty without a mesh
  Box3 gridBox() const {
    if (!field) return {};
    const Vec3 last(field->grid.nodes[0] - 1, field->grid.nodes[1] - 1, field->grid.nodes[2] - 1);
    return Box3(field->grid.origin, field->grid.toWorld(last));
  }
  // What people mean by the size of the scene: the mesh where there is one.
  Box3 box() const {
    Box3 all = mesh ? mesh_box : gridBox();
    if (layers.count(Layer::extent) && field) all.extend(gridBox());
    if (all.isEmpty()) all = Box3(Vec3::Constant(-0.05), Vec3::Constant(0.05));
    return all;
  }
  // What has to be in the picture: the mesh's own outline is tighter than its box.
  std::vector<Vec3> outermost(const Box3& box) const {
    std::vector<Vec3> points;
    const Vec3 centre = box.center();
    // Of many triangles every vertex is the first of some.
    const bool coarse = mesh && mesh->triangles.size() < 10'000;
    const double shell = shellShown() && isStored(*band, *field) ? band->edge : 0;
    if (mesh && !(on(Layer::extent) && field))
      for (const Triangle& triangle : mesh->triangles)
        for (std::size_t k = 0; k < (coarse ? 3 : 1); ++k) {
          const Vec3& point = mesh->positions[static_cast<std::size_t>(triangle[k])];
          if (!point.allFinite()) continue;
          points.push_back(point);
          if (shell > 0) points.push_back(point + shell * Vec3(point - centre).normalized());
        }
    if (points.empty())
      for (int i = 0; i < 8; ++i) points.push_back(box.corner(static_cast<Box3::CornerType>(i)));
    return points;
  }

  std::array<int, 2> size() const { // [pixels]
    auto* window = scene->GetRenderWindow();
    return window ? std::array{window->GetSize()[0], window->GetSize()[1]} : std::array{0, 0};
  }
  double aspect() const {
    const auto [wide, high] = size();
    return wide > 0 && high > 0 ? static_cast<double>(wide) / high : 4.0 / 3.0;
  }
  Lettering letters() const { return letteringOf(scene->GetRenderWindow(), ground); }
  bool on(Layer layer) const { return layers.count(layer) != 0; }
  bool mapShown() const { return on(Layer::stability) && has_stability; }
  bool bandShown() const { return on(Layer::band) && field != nullptr && band.has_value(); }
  // Colours that are read against a scale have nothing drawn over them.
  bool shellShown() const {
    return bandShown() && !mapShown() &&
           shownPaint().value_or(PaintQuantity::color) == PaintQuantity::color;
  }
  // Nullopt where no paint of a layer that is on is there to be seen.
  std::optional<PaintQuantity> shownPaint() const;
  std::optional<MaterialChannel> slicedMaterial() const; // on the slice, in place of distance
  int bars() const;                                      // scalar bars at the right edge
  double barShare() const;                               // of the picture's width, each

  void applyVisibility();
  void choosePaint();
  void makeCoarse();
  bool coarseShown() const { return moving && has_coarse && left_out.empty(); }
  void drawMesh(); // what of it is not drawn elsewhere
  void cutAt();
  void aimTool();
  void fitArrow(vtkCamera& camera, const Box3& box, std::vector<Vec3>& points, double aspect);
  void syncCorner();
};

} // namespace patina
