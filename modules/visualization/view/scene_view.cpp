#include "visualization/view/scene_view.h"

#include <algorithm>
#include <chrono>

#include <vtkCamera.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTransform.h>

#include "field/surface/iso_surface.h"
#include "visualization/surfaces/surface_data.h"
#include "visualization/view/camera.h"
#include "visualization/view/scene_view_parts.h"

namespace patina {
SceneView::SceneView() : impl_(std::make_unique<Impl>()) {
  Impl& my = *impl_;
  setBackground(*my.scene, my.ground);
  my.scene->AddActor(my.mesh_actor);
  my.scene->AddActor(my.iso_actor);
  addLights(*my.scene);
  const vtkNew<vtkProperty> inner;
  inner->DeepCopy(my.mesh_actor->GetProperty());
  inner->SetColor(palette::forVtk(palette::kSurfaceBack));
  inner->SetSpecular(0);
  my.mesh_actor->SetBackfaceProperty(inner);
  my.coarse_actor->SetProperty(my.mesh_actor->GetProperty());
  my.coarse_actor->SetBackfaceProperty(inner);
  my.scene->AddActor(my.coarse_actor);

  const vtkNew<vtkPolyDataMapper> mapper;
  my.outline->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
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
  my.corner->AddActor(my.axes);
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
  my.has_coarse = false;
  my.coarse_made = {};
  my.left_out.clear();
  my.painted = {}; // of another mesh, until setPaint() says otherwise
  my.choosePaint();
  my.applyVisibility();
  my.dirty = true;
}

void SceneView::setPaint(const Scene& scene,
                         const std::vector<std::shared_ptr<const TexelMap>>& texels) {
  Impl& my = *impl_;
  std::size_t faces = 0;
  bool any = false;
  for (const SceneObject& object : scene.objects) {
    faces += object.mesh->triangles.size();
    any = any || object.paint != nullptr;
  }
  const bool ours = my.mesh != nullptr && faces == my.mesh->triangles.size();
  if (!any && my.painted.objects.empty()) return;
  my.painted = any && ours ? scene : Scene{};
  my.texels = texels;
  my.choosePaint();
  my.applyVisibility();
  my.paint_stale = my.dirty = true;
}

void SceneView::lockPaintRange(PaintQuantity quantity, std::optional<ValueRange> range) {
  impl_->paint.lockRange(quantity, range);
  impl_->paint_stale = impl_->slice_stale = impl_->dirty = true;
}

ValueRange SceneView::paintRange(PaintQuantity quantity) const {
  return impl_->paint.range(quantity);
}

bool SceneView::hasPaint(PaintQuantity quantity) const {
  return impl_->paint.has(quantity);
}

void SceneView::setBrush(const std::optional<BrushPlace>& place) {
  if (place == impl_->brush_place) return;
  impl_->brush_place = place;
  impl_->brush_stale = impl_->dirty = true;
}

void SceneView::setMirror(const std::optional<MirrorPlace>& place) {
  Impl& my = *impl_;
  if (place == my.mirror_place) return;
  my.mirror_place = place;
  place ? void(my.mirror.emplace(*my.scene, *place)) : my.mirror.reset();
  my.dirty = true;
}

void SceneView::setField(std::shared_ptr<const SurfaceField> field) {
  Impl& my = *impl_;
  my.field = std::move(field);
  my.sample.reset();
  my.iso_stale = my.slice_stale = my.band_stale = my.nodes_stale = my.brush_stale = true;
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

void SceneView::setClip(const std::optional<ClipPlane>& plane) {
  Impl& my = *impl_;
  if (!plane)
    my.clip.reset();
  else if (my.clip)
    my.clip->set(*plane);
  else
    my.clip.emplace(*my.scene, *my.overlay, *plane);
  my.dirty = true;
}

double SceneView::clipLength() const {
  return impl_->clip ? impl_->clip->length() : 0;
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
  my.choosePaint();
  my.paint_stale = true;
  my.applyVisibility();
  my.dirty = true;
}

bool SceneView::shown(Layer layer) const {
  return impl_->on(layer);
}

void SceneView::setGround(const palette::Ground& ground) {
  impl_->ground = ground;
  setBackground(*impl_->scene, ground);
  impl_->dirty = true;
}

void SceneView::showCube(bool on) {
  Impl& my = *impl_;
  my.axes->SetVisibility(!on);
  on ? void(my.cube.emplace(*my.corner)) : my.cube.reset();
  my.corner->SetUseFXAA(on); // of so few pixels, at no cost
  my.dirty = true;
}

std::optional<Vec3> SceneView::cubeSideAt(double x, double y) const {
  const Impl& my = *impl_;
  const double* port = my.corner->GetViewport(); // of the last picture
  if (!my.cube || x > port[2] || y > port[3]) return std::nullopt;
  return patina::cubeSideAt(
      rayThrough(*my.corner->GetActiveCamera(), x / port[2] - 0.5, y / port[3] - 0.5));
}

void SceneView::setHot(const HotPart& hot) {
  Impl& my = *impl_;
  if (hot == my.hot) return;
  my.hot = hot;
  if (my.cube) my.cube->setHot(hot.cube_side);
  if (my.clip) my.clip->setHot(hot.clip);
  my.dirty = true;
}

void SceneView::setView(ViewPreset view) {
  turnCamera(*impl_->scene->GetActiveCamera(), view);
  fit();
}

void SceneView::setMoving(bool moving) {
  Impl& my = *impl_;
  const bool shown = my.coarseShown(), was = my.moving;
  my.moving = moving;
  if (moving) my.makeCoarse();
  if (my.coarse_made.valid() &&
      my.coarse_made.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    vtkPolyDataMapper::SafeDownCast(my.coarse_actor->GetMapper())
        ->SetInputData(my.coarse_made.get());
    my.has_coarse = true;
  }
  my.scene->SetPass(moving ? my.half_size.Get() : nullptr);
  my.dirty = my.dirty || my.coarseShown() != shown || was != moving;
}

void SceneView::fit() {
  Impl& my = *impl_;
  const Box3 box = my.box();
  vtkCamera& camera = *my.scene->GetActiveCamera();
  // Scalar bars stand at the right edge: what is fitted goes to their left.
  const bool tags = my.mapShown() && my.stability.hasTags();
  const double taken = my.barShare() * (my.bars() + (tags ? 0.7 : 0));
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
  if (my.paint_stale) {
    my.paint.prepare();
    my.drawMesh();
    my.paint_stale = false;
  }
  if (my.brush_stale) {
    my.brush.update(my.brush_place, my.field.get());
    my.brush_stale = false;
  }
  if (my.iso_stale && my.field && my.on(Layer::iso)) {
    vtkPolyDataMapper::SafeDownCast(my.iso_actor->GetMapper())
        ->SetInputData(surfaceData(isoSurface(*my.field, my.iso)));
    my.iso_stale = false;
  }
  if (my.slice_stale && my.field && my.on(Layer::slice)) {
    std::optional<SliceMaterial> material;
    if (const auto channel = my.slicedMaterial())
      material = SliceMaterial{&my.painted, *channel, my.paint.colors()};
    my.slice.update(*my.field, my.place, my.bandShown() ? my.band : std::nullopt, material);
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
  if (my.mirror) my.mirror->setGround(my.ground);
  if (my.clip) my.clip->prepare(my.box(), my.ground);
  const Lettering letters = my.letters();
  my.band_layer.setLettering(letters);
  my.tool.setLettering(letters);
  setLettering(*my.axes, letters);
  if (my.cube) my.cube->setGround(my.ground);
  vtkCamera* camera = my.scene->GetActiveCamera();
  my.syncCorner();
  my.tool.faceCamera(*camera);
  my.scale.update(*camera, my.size()[1], letters);
  my.applyVisibility();
  my.scene->ResetCameraClippingRange();
  const CameraPlace place = placeOf(*camera);
  const bool changed = my.dirty || place != my.drawn_from || my.size() != my.drawn_size;
  my.drawn_from = place;
  my.drawn_size = my.size();
  my.dirty = false;
  return changed;
}

} // namespace patina
