#include "visualization/scene_view.h"

#include <algorithm>
#include <optional>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkOutlineSource.h>
#include <vtkPlaneCollection.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTransform.h>

#include "field/iso_surface.h"
#include "visualization/band_layer.h"
#include "visualization/camera.h"
#include "visualization/node_layer.h"
#include "visualization/palette.h"
#include "visualization/scalar_bar.h"
#include "visualization/scene_furniture.h"
#include "visualization/slice_layer.h"
#include "visualization/stability_layer.h"
#include "visualization/surface_data.h"
#include "visualization/surface_pick.h"
#include "visualization/tool_layer.h"

namespace patina {
namespace {
constexpr double kBarWidth = 0.12; // of the picture
}

struct SceneView::Impl {
  vtkNew<vtkRenderer> scene, overlay, corner;
  vtkSmartPointer<vtkActor> mesh_actor = surfaceActor(palette::kSurface);
  vtkSmartPointer<vtkActor> iso_actor = surfaceActor(palette::kIso);
  vtkNew<vtkOutlineSource> outline;
  vtkNew<vtkActor> extent_actor;
  SliceLayer slice{*scene, *overlay};
  BandLayer band_layer{*scene, *overlay};
  StabilityLayer stability{*scene, *overlay};
  ToolLayer tool{*scene, *overlay};
  NodeLayer nodes{*overlay};

  std::shared_ptr<const TriangleMesh> mesh;
  std::shared_ptr<const SurfaceField> field;
  double iso = 0;
  SlicePlace place;
  std::optional<TouchBand> band;
  std::optional<ToolSample> sample;
  std::set<Layer> layers{Layer::mesh, Layer::band, Layer::tip};

  // What is out of date; made again by prepare() and only if it is shown.
  bool iso_stale = false, slice_stale = false, band_stale = false, nodes_stale = false;
  bool dirty = true, has_stability = false;
  bool cut_keeps_positive = true, cut_on = false;
  vtkMTimeType camera_time = 0;

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
    const double shell = shellShown() && isStored(*band, *field) ? band->edge : 0;
    if (mesh && !(on(Layer::extent) && field))
      for (const Triangle& triangle : mesh->triangles) {
        const Vec3& point = mesh->positions[static_cast<std::size_t>(triangle[0])];
        if (!point.allFinite()) continue;
        points.push_back(point);
        if (shell > 0) points.push_back(point + shell * Vec3(point - centre).normalized());
      }
    if (points.empty())
      for (int i = 0; i < 8; ++i) points.push_back(box.corner(static_cast<Box3::CornerType>(i)));
    return points;
  }

  double aspect() {
    if (auto* window = scene->GetRenderWindow()) {
      const int* pixels = window->GetSize();
      if (pixels[0] > 0 && pixels[1] > 0) return static_cast<double>(pixels[0]) / pixels[1];
    }
    return 4.0 / 3.0;
  }
  bool on(Layer layer) const { return layers.count(layer) != 0; }
  bool mapShown() const { return on(Layer::stability) && has_stability; }
  bool bandShown() const { return on(Layer::band) && field != nullptr && band.has_value(); }
  // Colours that are read against a scale have nothing drawn over them.
  bool shellShown() const { return bandShown() && !mapShown(); }

  void applyVisibility();
  void cutAt();
  void aimTool();
  void fitArrow(vtkCamera& camera, const Box3& box, std::vector<Vec3>& points, double aspect);
  void syncCorner();
};

void SceneView::Impl::applyVisibility() {
  const bool map = mapShown();
  stability.setVisible(map);
  placeScalarBar(stability.bar(), on(Layer::slice) && field != nullptr ? 1 : 0);
  mesh_actor->SetVisibility(on(Layer::mesh) && mesh != nullptr && !map);
  iso_actor->SetVisibility(on(Layer::iso) && field != nullptr);
  extent_actor->SetVisibility(on(Layer::extent) && field != nullptr);
  band_layer.setVisible(shellShown(), bandShown() && (!map || on(Layer::slice)));
  slice.setVisible(on(Layer::slice) && field != nullptr);
  tool.setVisible(on(Layer::tip) && sample.has_value());
  nodes.setVisible(on(Layer::nodes) && field != nullptr);
  for (vtkActor* actor : {mesh_actor.Get(), iso_actor.Get(), &stability.surface()})
    actor->GetProperty()->SetEdgeVisibility(on(Layer::wireframe));
  // Over the mesh the iso-surface is a shell that one sees through; alone it is the surface.
  const bool shell = map || (on(Layer::mesh) && mesh != nullptr);
  iso_actor->GetProperty()->SetOpacity(shell ? 0.38 : 1.0);
  iso_actor->GetProperty()->SetBackfaceCulling(shell);
}

// Surfaces in front of the slice would hide it: the half towards the camera is cut away.
void SceneView::Impl::cutAt() {
  vtkPlane& plane = slice.plane();
  const bool wanted = on(Layer::slice) && field != nullptr;
  const Vec3 eye(scene->GetActiveCamera()->GetPosition());
  const Vec3 normal = Vec3::Unit(place.axis);
  const bool keeps_positive = (eye - Vec3(plane.GetOrigin())).dot(normal) < 0;
  if (wanted) {
    Vec3 inward = keeps_positive ? normal : Vec3(-normal);
    plane.SetNormal(inward.data());
    // A hair behind the slice: the rims of what is cut would shine through its lines.
    Vec3 origin(plane.GetOrigin());
    origin[place.axis] = slice.position() + (keeps_positive ? 1 : -1) * 0.35 * field->grid.voxel;
    plane.SetOrigin(origin.data());
  }
  if (wanted == cut_on && keeps_positive == cut_keeps_positive) return;
  cut_on = wanted;
  cut_keeps_positive = keeps_positive;
  for (vtkActor* actor :
       {mesh_actor.Get(), iso_actor.Get(), &band_layer.shell(), &stability.surface()}) {
    actor->GetMapper()->RemoveAllClippingPlanes();
    if (wanted) actor->GetMapper()->AddClippingPlane(&plane);
  }
  dirty = true;
}

// The arrow keeps its size in the picture, so that it reaches farther the farther the camera goes:
// each round is nearer to where both fit, since the arrow is shorter than the picture.
void SceneView::Impl::fitArrow(vtkCamera& camera, const Box3& box, std::vector<Vec3>& points,
                               double aspect) {
  const double distance = camera.GetDistance();
  Vec3 centre = box.center();
  points.emplace_back();
  for (int round = 0; round < 8; ++round) {
    tool.faceCamera(camera);
    const auto end = tool.arrowEnd();
    if (!end) return;
    points.back() = *end;
    if (round > 0) centre = Box3(box).extend(*end).center();
    fitCamera(camera, centre, points, aspect);
    if (round == 0 && camera.GetDistance() <= distance) return; // it was in the picture
  }
}

// Before a hand moved it, the tip rests on the surface in the middle of the picture.
void SceneView::Impl::aimTool() {
  if (sample || !field || !(on(Layer::tip) || on(Layer::nodes))) return;
  const Ray ray = rayThrough(*scene->GetActiveCamera(), 0, 0);
  const auto hit = firstSurfaceAlong(*field, ray.origin, ray.direction);
  if (!hit) return;
  sample.emplace();
  sample->tip = sample->vcp = sample->surface = *hit;
  tool.update(*sample);
  nodes_stale = true;
}

void SceneView::Impl::syncCorner() {
  vtkCamera* camera = scene->GetActiveCamera();
  Vec3 back = (Vec3(camera->GetPosition()) - Vec3(camera->GetFocalPoint())).normalized() * 5.2;
  vtkCamera* small = corner->GetActiveCamera();
  small->SetPosition(back.data());
  small->SetFocalPoint(0, 0, 0);
  small->SetViewUp(camera->GetViewUp());
  corner->ResetCameraClippingRange();
}

SceneView::SceneView() : impl_(std::make_unique<Impl>()) {
  Impl& my = *impl_;
  my.scene->SetBackground(palette::forVtk(palette::kBackgroundLow));
  my.scene->SetBackground2(palette::forVtk(palette::kBackgroundHigh));
  my.scene->GradientBackgroundOn();
  my.scene->AddActor(my.mesh_actor);
  my.scene->AddActor(my.iso_actor);
  // At 0 the iso-surface lies on the mesh: it is drawn as if a hair nearer.
  auto* iso_mapper = vtkPolyDataMapper::SafeDownCast(my.iso_actor->GetMapper());
  iso_mapper->SetResolveCoincidentTopologyToPolygonOffset();
  iso_mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(-2, -2);
  addLights(*my.scene);
  const vtkNew<vtkProperty> inner;
  inner->DeepCopy(my.mesh_actor->GetProperty());
  inner->SetColor(palette::forVtk(palette::kSurfaceBack));
  inner->SetSpecular(0);
  my.mesh_actor->SetBackfaceProperty(inner);

  const vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(my.outline->GetOutputPort());
  my.extent_actor->SetMapper(mapper);
  my.extent_actor->GetProperty()->SetColor(palette::forVtk(palette::kQuiet));
  my.extent_actor->GetProperty()->SetLineWidth(1.5);
  my.extent_actor->GetProperty()->LightingOff();
  my.scene->AddActor(my.extent_actor);

  my.overlay->SetLayer(1);
  my.overlay->InteractiveOff();
  my.overlay->SetActiveCamera(my.scene->GetActiveCamera());
  addLights(*my.overlay);
  my.corner->SetLayer(1);
  my.corner->InteractiveOff();
  my.corner->SetViewport(0.0, 0.0, 0.13, 0.17);
  my.corner->AddActor(axesActor());
  my.applyVisibility();
}

SceneView::~SceneView() = default;

void SceneView::attachTo(vtkRenderWindow& window) {
  window.SetNumberOfLayers(2);
  window.AddRenderer(impl_->scene);
  window.AddRenderer(impl_->overlay);
  window.AddRenderer(impl_->corner);
}

vtkRenderer& SceneView::renderer() {
  return *impl_->scene;
}

void SceneView::setMesh(std::shared_ptr<const TriangleMesh> mesh) {
  Impl& my = *impl_;
  my.mesh = std::move(mesh);
  my.mesh_box = my.mesh ? bounds(*my.mesh) : Box3();
  auto* mapper = vtkPolyDataMapper::SafeDownCast(my.mesh_actor->GetMapper());
  mapper->SetInputData(my.mesh ? surfaceData(*my.mesh) : vtkSmartPointer<vtkPolyData>::New());
  my.applyVisibility();
  my.dirty = true;
}

void SceneView::setField(std::shared_ptr<const SurfaceField> field) {
  Impl& my = *impl_;
  my.field = std::move(field);
  my.sample.reset();
  my.iso_stale = my.slice_stale = my.band_stale = my.nodes_stale = true;
  if (my.field) {
    const Box3 box = my.gridBox();
    my.outline->SetBounds(box.min()[0], box.max()[0], box.min()[1], box.max()[1], box.min()[2],
                          box.max()[2]);
  }
  my.applyVisibility();
  my.dirty = true;
}

void SceneView::setIso(double iso) {
  impl_->iso_stale = impl_->iso_stale || iso != impl_->iso;
  impl_->iso = iso;
  impl_->dirty = true;
}

void SceneView::setSlice(const SlicePlace& place) {
  impl_->place = place;
  impl_->slice_stale = impl_->dirty = true;
}

void SceneView::setBand(const std::optional<TouchBand>& band) {
  Impl& my = *impl_;
  if (band == my.band) return;
  my.band = band;
  my.band_stale = my.slice_stale = my.dirty = true;
  my.applyVisibility();
}

void SceneView::setStability(const TriangleMesh* surface, const std::vector<float>& ratio) {
  Impl& my = *impl_;
  my.has_stability = surface != nullptr;
  if (surface) my.stability.update(*surface, ratio);
  my.applyVisibility();
  my.dirty = true;
}

void SceneView::setTipRadius(double radius) {
  impl_->tool.setTipRadius(radius);
  impl_->dirty = true;
}

void SceneView::setTool(const ToolSample& sample) {
  Impl& my = *impl_;
  const bool first = !my.sample.has_value();
  if (!first && my.sample->tip == sample.tip && my.sample->vcp == sample.vcp &&
      my.sample->force == sample.force && my.sample->surface == sample.surface)
    return;
  my.sample = sample;
  my.tool.update(sample);
  if (first) my.applyVisibility();
  my.nodes_stale = true;
  my.dirty = true;
}

void SceneView::show(Layer layer, bool on) {
  std::set<Layer> layers = impl_->layers;
  if (on)
    layers.insert(layer);
  else
    layers.erase(layer);
  showOnly(layers);
}

void SceneView::showOnly(const std::set<Layer>& layers) {
  Impl& my = *impl_;
  // The band tints the slice.
  if (layers.count(Layer::band) != my.layers.count(Layer::band)) my.slice_stale = true;
  my.layers = layers;
  my.applyVisibility();
  my.dirty = true;
}

bool SceneView::shown(Layer layer) const {
  return impl_->on(layer);
}

void SceneView::setView(ViewPreset view) {
  turnCamera(*impl_->scene->GetActiveCamera(), view);
  fit();
}

void SceneView::fit() {
  Impl& my = *impl_;
  const Box3 box = my.box();
  vtkCamera& camera = *my.scene->GetActiveCamera();
  // Scalar bars stand at the right edge: what is fitted goes to their left.
  const int bars = (my.on(Layer::slice) && my.field ? 1 : 0) + (my.mapShown() ? 1 : 0);
  const double taken = kBarWidth * bars;
  const double aspect = my.aspect() * (1 - taken);
  std::vector<Vec3> points = my.outermost(box);
  fitCamera(camera, box.center(), points, aspect);
  my.fitArrow(camera, box, points, aspect);
  pan(camera, -0.5 * taken * my.aspect(), 0);
  my.dirty = true;
}

Box3 SceneView::extent() const {
  return impl_->box();
}

bool SceneView::prepare() {
  Impl& my = *impl_;
  my.aimTool();
  if (my.iso_stale && my.field && my.on(Layer::iso)) {
    vtkPolyDataMapper::SafeDownCast(my.iso_actor->GetMapper())
        ->SetInputData(surfaceData(isoSurface(*my.field, my.iso)));
    my.iso_stale = false;
  }
  if (my.slice_stale && my.field && my.on(Layer::slice)) {
    my.slice.update(*my.field, my.place, my.bandShown() ? my.band : std::nullopt);
    my.slice_stale = false;
  }
  if (my.band_stale && my.bandShown()) {
    my.band_layer.update(*my.field, *my.band);
    my.band_stale = false;
  }
  if (my.nodes_stale && my.field && my.sample && my.on(Layer::nodes)) {
    my.nodes.update(*my.field, my.sample->tip);
    my.nodes_stale = false;
  }
  my.cutAt();
  my.slice.setTextSize(textSize(my.scene->GetRenderWindow()));
  my.band_layer.setTextSize(textSize(my.scene->GetRenderWindow()));
  my.stability.setTextSize(textSize(my.scene->GetRenderWindow()));
  vtkCamera* camera = my.scene->GetActiveCamera();
  my.tool.faceCamera(*camera);
  my.applyVisibility();
  my.syncCorner();
  my.scene->ResetCameraClippingRange();
  const bool camera_moved = camera->GetViewTransformObject()->GetMTime() != my.camera_time;
  my.camera_time = camera->GetViewTransformObject()->GetMTime();
  const bool changed = my.dirty || camera_moved;
  my.dirty = false;
  return changed;
}

} // namespace patina
