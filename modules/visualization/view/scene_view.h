// Picture of a scene with one object per layer. No window and no Qt. UI thread only.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <vector>

#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include "field/store/surface_field.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/scene.h"
#include "scene/slice_position.h"
#include "scene/tool_sample.h"
#include "visualization/layers/annotation_layer.h"
#include "visualization/layers/brush_cursor.h"
#include "visualization/layers/clip_layer.h"
#include "visualization/layers/mirror_layer.h"
#include "visualization/layers/paint_layer.h"
#include "visualization/values/figure.h"
#include "visualization/values/touch_band.h"
#include "visualization/values/view_options.h"

namespace patina {

// Part of the view cube or of a plane's handle under the pointer.
struct HoveredPart {
  std::optional<Vec3> cube_side;
  std::optional<ClipPart> clip; // belongs to the clip plane or the slice
  bool of_slice = false;
  bool operator==(const HoveredPart&) const = default;
};

// The drawn thing that is in front on a view ray, and where.
struct Front {
  Layer layer = Layer::mesh; // mesh (also where paint or stability is drawn), iso or slice
  Vec3 point = Vec3::Zero(); // [m]
  std::size_t slice = 0;     // its number from 0, if it is a slice
};

class SceneView {
 public:
  SceneView();
  ~SceneView();
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  // Adds the two renderers (the scene, and an overlay that nothing hides) to a window.
  void attachTo(vtkRenderWindow& window);
  vtkRenderer& renderer();

  // A layer without data shows nothing. Neither call moves the camera; see fit().
  void setMesh(std::shared_ptr<const TriangleMesh> mesh);         // nullptr = none
  void setField(std::shared_ptr<const SurfaceField> field);       // nullptr = none
  void setIso(double iso);                                        // [m]
  void setSlices(const Slices& places, std::size_t selected = 0); // the selected one has a handle
  // Plane of that slice; its origin is nearest to the middle of the field. Nullopt: not shown.
  std::optional<ClipPlane> slicePlane() const;
  void setSliceHandle(bool on);
  // Hides surfaces in front of the plane and shows its handle; nullopt: no clipping.
  void setClip(const std::optional<ClipPlane>& plane);
  // Length of the handle of the clip plane, or of the slice [m].
  double handleLength(bool of_slice) const;
  // A straight line in front of everything; nullopt: none.
  void setLine(const std::optional<std::pair<Vec3, Vec3>>& ends);
  // For the layer band; nullopt = neither offset nor magnet.
  void setBand(const std::optional<TouchBand>& band);
  // For the layer stability, which replaces the mesh: a surface and one K*/K per vertex. nullptr =
  // none, and the mesh is shown.
  void setStability(const TriangleMesh* surface, const std::vector<float>& ratio);
  // Paint of the layers color, relief and material; call it after every edit and dab (only changes
  // are drawn). The objects of `scene`, one after another, must form the mesh; objects without the
  // shown paint stay in the layer mesh. A scene without paint costs nothing. See PaintLayer.
  void setPaint(const Scene& scene,
                const std::vector<std::shared_ptr<const TexelMap>>& texels = {});
  // Colours, ranges and opacities of slice, iso-surface, mesh and paint.
  void setColors(const ColorScales& scales);
  // Range of the colours of a drawn thing, after prepare(); nullopt if it has none.
  std::optional<ValueRange> shownRange(const std::string& thing) const;
  ValueRange paintRange(PaintQuantity quantity) const; // range shown
  bool hasPaint(PaintQuantity quantity) const;
  void setBrush(const std::optional<BrushCursorState>& place); // nullopt: no cursor
  void setMirror(const std::optional<MirrorState>& place);     // mirror of strokes; nullopt: none
  void setAnnotations(const std::vector<Annotation>& annotations); // measurements and pins
  void setTipRadius(double radius); // [m]; 0 = a point, drawn as a small sphere
  // See ToolLayer::update().
  void setTool(const ToolSample& sample, const std::optional<Vec3>& nearest = {});

  void show(Layer layer, bool on);
  void showOnly(const std::set<Layer>& layers);
  bool shown(Layer layer) const;
  // Returns what of mesh, iso-surface and slice is in front on the ray, to a hundredth of a voxel;
  // parts that the slice or the clip plane hides do not count. nullopt: none, or no field.
  std::optional<Front> frontAlong(const Ray& view_ray) const;
  // Returns the mesh's visible vertex nearest to the ray, if it is nearer than the other ray is at
  // its depth.
  std::optional<Vec3> vertexNear(const Ray& view_ray, const Ray& reach) const;

  // Shows the view cube instead of the axes. cubeSideAt() takes a position 0 .. 1 in the picture
  // from the lower left; see ViewCube.
  void showCube(bool on);
  std::optional<Vec3> cubeSideAt(double x, double y) const;
  void setHighlighted(const HoveredPart& hovered); // draws part of cube or handle brighter

  void setBackgroundStyle(const palette::BackgroundStyle& ground); // default: light
  const palette::BackgroundStyle& backgroundStyle() const;
  // Leaves out these parts, cursor and handles until nullopt is set.
  void setFigureParts(const std::optional<std::set<FigurePart>>& without);
  void setView(ViewPreset view); // resets the camera
  // Level of detail while the camera moves, if rendering is slow: bodies at half the resolution,
  // and a large mesh with fewer triangles once a background task has made it.
  void setInteracting(bool moving);
  void setSmooth(bool on); // edges (FXAA); call between prepare() and the render
  void fit();              // everything, from the present direction
  Box3 extent() const;     // extent of mesh and field; never empty

  // Call before a render: updates everything that depends on the camera. Returns true if something
  // changed since the last call.
  bool prepare();
  // After prepare(): only tool, cursor, lines or annotations have moved, and the next render draws
  // them over the picture of the bodies that it has kept.
  bool keepsBodies() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> my_;
};

} // namespace patina
