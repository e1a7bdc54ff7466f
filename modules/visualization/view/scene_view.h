// The picture of a scene: one object a layer, no window and no Qt. UI thread only.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <vector>

#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "field/store/surface_field.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/scene.h"
#include "scene/tool_sample.h"
#include "visualization/layers/brush_cursor.h"
#include "visualization/layers/clip_layer.h"
#include "visualization/layers/mirror_layer.h"
#include "visualization/layers/paint_layer.h"
#include "visualization/values/touch_band.h"
#include "visualization/view/view_options.h"

namespace patina {

// A plane of the field: normal to an axis, at a fraction of the grid's extent along it.
struct SlicePlace {
  int axis = 1;          // 0 = x, 1 = y, 2 = z
  double position = 0.5; // 0 .. 1
};

// What of the cube in the corner, or of the clip plane's handle, is pointed at.
struct HotPart {
  std::optional<Vec3> cube_side;
  std::optional<ClipPart> clip;
  bool operator==(const HotPart&) const = default;
};

class SceneView {
 public:
  SceneView();
  ~SceneView();
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  // Adds the two renderers (scene, and what must never be hidden by it) to a window.
  void attachTo(vtkRenderWindow& window);
  vtkRenderer& renderer();

  // A layer whose thing is absent shows nothing. Neither call moves the camera; see fit().
  void setMesh(std::shared_ptr<const TriangleMesh> mesh);   // nullptr = none
  void setField(std::shared_ptr<const SurfaceField> field); // nullptr = none
  void setIso(double iso);                                  // [m]
  void setSlice(const SlicePlace& place);
  // Surfaces are drawn behind the plane only, which has a handle; nullopt: whole.
  void setClip(const std::optional<ClipPlane>& plane);
  // Of the plane that there is: the length of its handle [m].
  double clipLength() const;
  // Of the layer band; nullopt = the surface is felt where it is.
  void setBand(const std::optional<TouchBand>& band);
  // Of the layer stability, which takes the mesh's place: a surface and one K*/K a vertex. nullptr
  // = none, and the mesh is shown.
  void setStability(const TriangleMesh* surface, const std::vector<float>& ratio);
  // Paint of the layers color, relief and material; call it after every edit and dab (only what
  // changed is drawn anew). `scene` is the one whose objects, one after another, are the mesh;
  // objects without paint of what is shown stay in the layer mesh. A scene without paint costs
  // nothing. See PaintLayer.
  void setPaint(const Scene& scene,
                const std::vector<std::shared_ptr<const TexelMap>>& texels = {});
  // nullopt: the range follows what is painted.
  void lockPaintRange(PaintQuantity quantity, std::optional<ValueRange> range);
  ValueRange paintRange(PaintQuantity quantity) const; // as shown
  bool hasPaint(PaintQuantity quantity) const;
  void setBrush(const std::optional<BrushPlace>& place);   // nullopt: no cursor
  void setMirror(const std::optional<MirrorPlace>& place); // of strokes; nullopt: none
  void setTipRadius(double radius); // [m]; 0 = a point, drawn as a small sphere
  void setTool(const ToolSample& sample);

  void show(Layer layer, bool on);
  void showOnly(const std::set<Layer>& layers);
  bool shown(Layer layer) const;

  // A cube in the corner in place of the axes. Its side that is at a place of the picture, 0 .. 1
  // from the lower left; see ViewCube.
  void showCube(bool on);
  std::optional<Vec3> cubeSideAt(double x, double y) const;
  void setHot(const HotPart& hot); // of cube and handle; is drawn brighter

  void setGround(const palette::Ground& ground); // light, unless said
  void setView(ViewPreset view);                 // and fit
  // While the camera moves and that takes long: bodies are drawn at half the resolution, and a mesh
  // of many triangles with fewer, once these are made, which is done behind the picture.
  void setMoving(bool moving);
  void fit();          // everything in the picture, from the present direction
  Box3 extent() const; // of mesh and field; never empty

  // Call before a render: places what depends on the camera. True if something changed since the
  // last call.
  bool prepare();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
