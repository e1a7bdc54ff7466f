#include "visualization/view/scene_view.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <utility>

#include <vtkActor.h>
#include <vtkLineSource.h>
#include <vtkOutlineSource.h>
#include <vtkPlaneCollection.h>
#include <vtkProperty.h>
#include <vtkScalarBarActor.h>

#include "field/surface/iso_surface.h"
#include "scene/surface_pick.h"
#include "visualization/layers/band_layer.h"
#include "visualization/layers/node_layer.h"
#include "visualization/layers/scale_layer.h"
#include "visualization/layers/slice_layer.h"
#include "visualization/layers/stability_layer.h"
#include "visualization/layers/tool_layer.h"
#include "visualization/layers/view_cube.h"
#include "visualization/surfaces/surface_data.h"
#include "visualization/values/scalar_bar.h"
#include "visualization/values/scene_setup.h"
#include "visualization/view/picture_stage.h"
#include "visualization/view/view_mesh.h"

namespace patina {

struct SceneView::Impl : PictureStage {
  std::optional<ViewCube> cube; // replaces the axes
  HoveredPart hovered;
  vtkSmartPointer<vtkActor> mesh_actor = surfaceActor(palette::kSurface);
  vtkSmartPointer<vtkActor> iso_actor = surfaceActor(palette::kIso);
  // while the camera moves
  vtkSmartPointer<vtkActor> coarse_actor = surfaceActor(palette::kSurface);
  std::future<vtkSmartPointer<vtkPolyData>> coarse_made; // being made
  bool has_coarse = false, moving = false;
  vtkNew<vtkOutlineSource> outline;
  vtkSmartPointer<vtkActor> extent_actor = outlineActor(*outline);
  SliceLayer slice{*scene, *overlay};
  BandLayer band_layer{*foreground, *overlay}; // its shell is translucent: after the tool
  StabilityLayer stability{*scene, *overlay};
  ToolLayer tool{*foreground, *overlay};
  NodeLayer nodes{*overlay};
  PaintLayer paint{*scene, *overlay};
  BrushCursor brush{*overlay};
  ScaleLayer scale{*overlay};
  std::optional<ClipLayer> clip, slice_handle;
  vtkSmartPointer<vtkActor> line = surfaceActor(palette::kTool);
  bool has_slice_handle = false;
  AnnotationLayer annotations{*overlay};
  std::vector<Annotation> annotated;
  std::optional<MirrorLayer> mirror;
  std::optional<MirrorState> mirror_place;

  std::shared_ptr<const TriangleMesh> mesh;
  Scene painted; // empty if nothing is painted or the mesh is another
  std::vector<std::shared_ptr<const TexelMap>> texels; // one per object, or none
  std::vector<bool> left_out; // objects that the mesh's actor does not draw
  std::shared_ptr<const SurfaceField> field;
  double iso = 0;
  Slices slice_places;
  std::size_t selected_slice = 0; // has the handle
  ColorScales scales;
  std::optional<TouchBand> band;
  std::optional<ToolSample> sample;
  std::set<Layer> layers{Layer::mesh, Layer::color, Layer::band, Layer::tip};
  std::optional<BrushCursorState> brush_place;
  std::optional<std::set<FigurePart>> without; // parts that a figure leaves out

  // Outdated parts; prepare() updates those that are shown.
  bool iso_stale = false, slice_stale = false, band_stale = false, nodes_stale = false;
  bool paint_stale = false, brush_stale = false;
  bool has_stability = false;
  std::vector<vtkPlane*> cut_by; // clip planes of the surfaces

  Box3 mesh_box; // empty without a mesh
  Box3 gridBox() const { return field ? boxOf(field->grid) : Box3(); }
  // Extent of the scene: that of the mesh if there is one.
  Box3 box() const {
    Box3 all = mesh ? mesh_box : gridBox();
    if (layers.count(Layer::extent) && field) all.extend(gridBox());
    if (all.isEmpty()) all = Box3(Vec3::Constant(-0.05), Vec3::Constant(0.05));
    return all;
  }
  // Points that must be in the picture: vertices are tighter than the mesh's box.
  std::vector<Vec3> outermost(const Box3& box) const {
    std::vector<Vec3> points;
    const double shell = shellShown() && isStored(*band, *field) ? band->edge : 0;
    if (mesh && !(on(Layer::extent) && field)) points = outermostPoints(*mesh, box.center(), shell);
    if (points.empty())
      for (int i = 0; i < 8; ++i) points.push_back(box.corner(static_cast<Box3::CornerType>(i)));
    return points;
  }

  double aspect() const {
    const auto [wide, high] = size();
    return wide > 0 && high > 0 ? static_cast<double>(wide) / high : 4.0 / 3.0;
  }
  bool on(Layer layer) const { return layers.count(layer) != 0; }
  bool has(FigurePart part) const { return !without || without->count(part) == 0; }
  bool sliceShown() const { return on(Layer::slice) && field != nullptr; }
  bool mapShown() const { return on(Layer::stability) && has_stability; }
  bool bandShown() const { return on(Layer::band) && field != nullptr && band.has_value(); }
  // Nothing is drawn over colours that are read against a scale.
  bool shellShown() const {
    return bandShown() && !mapShown() &&
           shownPaint().value_or(PaintQuantity::color) == PaintQuantity::color;
  }
  // Nullopt if no layer that is on has visible paint.
  std::optional<PaintQuantity> shownPaint() const;
  std::optional<MaterialChannel> slicedMaterial() const; // on the slice, instead of distance
  int bars() const;                                      // number of scalar bars at the right edge
  // Width of each, as a fraction of the picture's.
  double barShare() const { return scalarBarShare(size()[0], letters()); }

  void applyVisibility();
  void choosePaint();
  void makeCoarse();
  bool coarseShown() const { return moving && has_coarse && left_out.empty(); }
  void drawMesh(); // draws the objects that no other layer draws
  void cutAt();
  std::optional<Front> surfaceAlong(const Ray& ray) const;
  void aimTool();
  std::optional<ClipPlane> slicePlane() const;
  void placeSliceHandle();
  void fitArrow(const Box3& box, std::vector<Vec3>& points, double aspect);
};

std::optional<PaintQuantity> SceneView::Impl::shownPaint() const {
  if (painted.objects.empty() || mapShown()) return std::nullopt;
  for (int q = kPaintQuantities - 1; q >= 0; --q) {
    const auto quantity = static_cast<PaintQuantity>(q);
    if (on(layerOf(quantity)) && paint.has(quantity)) return quantity;
  }
  return std::nullopt;
}

std::optional<MaterialChannel> SceneView::Impl::slicedMaterial() const {
  const auto quantity = shownPaint();
  return quantity && on(Layer::slice) && field ? channelOf(*quantity) : std::nullopt;
}

int SceneView::Impl::bars() const {
  const auto quantity = shownPaint();
  const bool paint_bar = quantity && *quantity != PaintQuantity::color;
  const bool distance_bar = sliceShown() && !slicedMaterial();
  if (!has(FigurePart::legend)) return 0;
  return (distance_bar ? 1 : 0) + (mapShown() ? 1 : 0) + (paint_bar ? 1 : 0);
}

void SceneView::Impl::choosePaint() {
  const auto before = slicedMaterial();
  paint.set(painted, texels);
  paint.show(shownPaint());
  if (slicedMaterial() || before) slice_stale = true;
}

// The task holds the mesh, because the view may get another one before it ends.
void SceneView::Impl::makeCoarse() {
  constexpr std::size_t kMany = 20'000;
  constexpr int kCells = 48; // about 14,000 triangles
  if (mesh && mesh->triangles.size() > kMany && !coarse_made.valid() && !has_coarse)
    coarse_made =
        std::async(std::launch::async, [shown = mesh] { return coarseData(*shown, kCells); });
}

void SceneView::Impl::drawMesh() {
  std::vector<bool> out;
  for (std::size_t object = 0; object < painted.objects.size(); ++object)
    out.push_back(paint.draws(object));
  if (std::none_of(out.begin(), out.end(), [](bool o) { return o; })) out.clear();
  if (out == left_out) return;
  left_out = out;
  mapperOf(*mesh_actor)
      .SetInputData(
          !mesh ? vtkSmartPointer<vtkPolyData>::New()
                : surfaceData(left_out.empty() ? *mesh : withoutObjects(*mesh, painted, left_out)));
}

void SceneView::Impl::applyVisibility() {
  const bool map = mapShown();
  stability.setVisible(map);
  const int places = bars();
  placeScalarBar(slice.bar(), 0, letters(), size());
  placeScalarBar(stability.bar(), places - 1, letters(), size());
  placeScalarBar(paint.bar(), places - 1, letters(), size());
  paint.setVisible(shownPaint().has_value());
  paint.setWireframe(on(Layer::wireframe));
  // At 0 the iso-surface coincides with the mesh; one is hidden, because both would flicker.
  const bool same = field && std::abs(iso) < 0.5 * field->grid.voxel;
  const bool as_iso = same && on(Layer::iso) && !map && !shownPaint();
  const bool plain = on(Layer::mesh) && mesh != nullptr && !map && !as_iso;
  mesh_actor->SetVisibility(plain && !coarseShown());
  coarse_actor->SetVisibility(plain && coarseShown());
  iso_actor->SetVisibility(on(Layer::iso) && field != nullptr && (as_iso || !same));
  extent_actor->SetVisibility(on(Layer::extent) && field != nullptr);
  band_layer.setVisible(shellShown(),
                        bandShown() && (!map || on(Layer::slice)) && has(FigurePart::legend));
  slice.setVisible(sliceShown());
  tool.setVisible(on(Layer::tip) && sample.has_value() && has(FigurePart::tool));
  scale.setVisible(on(Layer::scale) && (mesh != nullptr || field != nullptr) &&
                   has(FigurePart::scale));
  corner->SetDraw(has(FigurePart::cube));
  if (!has(FigurePart::legend))
    for (vtkScalarBarActor* bar : {&slice.bar(), &stability.bar(), &paint.bar()})
      bar->VisibilityOff();
  nodes.setVisible(on(Layer::nodes) && field != nullptr);
  for (vtkActor* actor : {mesh_actor.Get(), iso_actor.Get(), &stability.surface()})
    actor->GetProperty()->SetEdgeVisibility(on(Layer::wireframe));
  // The iso-surface is translucent over a mesh and opaque alone.
  const bool shell = !as_iso && (map || shownPaint() || (on(Layer::mesh) && mesh != nullptr));
  iso_actor->GetProperty()->SetOpacity(scaleOf(scales, "iso").opacity.value_or(shell ? 0.38 : 1.0));
  mesh_actor->GetProperty()->SetOpacity(scaleOf(scales, "mesh").opacity.value_or(1));
  iso_actor->GetProperty()->SetBackfaceCulling(shell);
}

// Removes what is in front of a slice, which would hide it, or of the clip plane.
void SceneView::Impl::cutAt() {
  std::vector<vtkPlane*> planes;
  if (sliceShown()) {
    dirty = slice.turnCuts(Vec3(camera().GetPosition()), *field) || dirty;
    planes = slice.cuts();
  }
  if (clip) planes.push_back(&clip->cut());
  if (planes == cut_by) return;
  cut_by = planes;
  vtkSmartPointer<vtkPlaneCollection> cuts;
  if (!planes.empty()) cuts = vtkSmartPointer<vtkPlaneCollection>::New();
  for (vtkPlane* plane : planes) cuts->AddItem(plane);
  for (vtkActor* actor : {mesh_actor.Get(), coarse_actor.Get(), iso_actor.Get(),
                          &band_layer.shell(), &stability.surface()})
    actor->GetMapper()->SetClippingPlanes(cuts);
  paint.setCuts(cuts);
  dirty = true;
}

// Iterates until camera and arrow fit: the arrow keeps its size in the picture and so grows with
// the camera's distance. Converges, because the arrow is shorter than the picture.
void SceneView::Impl::fitArrow(const Box3& box, std::vector<Vec3>& points, double aspect) {
  const double distance = camera().GetDistance();
  Vec3 centre = box.center();
  points.emplace_back();
  for (int round = 0; round < 8; ++round) {
    tool.faceCamera(camera());
    const auto end = tool.arrowEnd();
    if (!end) return;
    points.back() = *end;
    if (round > 0) centre = Box3(box).extend(*end).center();
    resetCameraTo(camera(), centre, points, aspect);
    if (round == 0 && camera().GetDistance() <= distance) return; // it was in the picture
  }
}

std::optional<ClipPlane> SceneView::Impl::slicePlane() const {
  if (!sliceShown()) return std::nullopt;
  const SlicePosition there =
      within(field->grid, slice_places[selected_slice].value_or(SlicePosition{}));
  const Vec3 middle = gridBox().center();
  return ClipPlane{middle + (*there.position - there.normal.dot(middle)) * there.normal,
                   there.normal};
}

void SceneView::Impl::placeSliceHandle() {
  const auto plane = has_slice_handle && !without ? slicePlane() : std::nullopt;
  if (!plane) return slice_handle.reset();
  if (!slice_handle) slice_handle.emplace(*scene, *overlay, *plane);
  slice_handle->set(*plane);
  slice_handle->setHighlighted(hovered.of_slice ? hovered.clip : std::nullopt);
  slice_handle->prepare(box(), ground);
}

std::optional<Front> SceneView::Impl::surfaceAlong(const Ray& ray) const {
  std::optional<Front> front;
  const auto add = [&](Layer layer, double level) {
    const auto point = firstCrossingAlong(*field, ray.origin, ray.direction, level);
    if (point && (!front || (*point - front->point).dot(ray.direction) < 0))
      front = Front{layer, *point};
  };
  if (on(Layer::iso)) add(Layer::iso, iso);
  if (mapShown() || shownPaint() || (on(Layer::mesh) && mesh)) add(Layer::mesh, 0);
  return front;
}

// The tip rests on the surface in the middle of the picture until the user moves it.
void SceneView::Impl::aimTool() {
  if (sample || !field || !(on(Layer::tip) || on(Layer::nodes))) return;
  const Ray ray = rayThrough(camera(), 0, 0);
  const auto hit = firstSurfaceAlong(*field, ray.origin, ray.direction);
  if (!hit) return;
  sample = ToolSample{.tip = *hit, .vcp = *hit, .surface = *hit};
  tool.update(*sample);
  nodes_stale = true;
}

SceneView::SceneView() : my_(std::make_unique<Impl>()) {
  my_->scene->AddActor(my_->mesh_actor);
  my_->scene->AddActor(my_->iso_actor);
  const vtkNew<vtkProperty> inner;
  inner->DeepCopy(my_->mesh_actor->GetProperty());
  inner->SetColor(palette::forVtk(palette::kSurfaceBack));
  inner->SetSpecular(0);
  my_->mesh_actor->SetBackfaceProperty(inner);
  my_->coarse_actor->SetProperty(my_->mesh_actor->GetProperty());
  my_->coarse_actor->SetBackfaceProperty(inner);
  my_->scene->AddActor(my_->coarse_actor);

  my_->scene->AddActor(my_->extent_actor);

  my_->line->GetProperty()->LightingOff();
  my_->line->GetProperty()->SetLineWidth(2.5);
  my_->overlay->AddActor(my_->line);

  my_->setUp();
  my_->applyVisibility();
}

SceneView::~SceneView() = default;

void SceneView::attachTo(vtkRenderWindow& window) {
  my_->attachTo(window);
}

vtkRenderer& SceneView::renderer() {
  return *my_->scene;
}

void SceneView::setMesh(std::shared_ptr<const TriangleMesh> mesh) {
  my_->mesh = std::move(mesh);
  my_->mesh_box = my_->mesh ? bounds(*my_->mesh) : Box3();
  mapperOf(*my_->mesh_actor)
      .SetInputData(my_->mesh ? surfaceData(*my_->mesh) : vtkSmartPointer<vtkPolyData>::New());
  my_->has_coarse = false;
  my_->coarse_made = {};
  my_->left_out.clear();
  my_->painted = {}; // paint of another mesh, until setPaint()
  my_->choosePaint();
  my_->applyVisibility();
  my_->dirty = true;
}

void SceneView::setPaint(const Scene& scene,
                         const std::vector<std::shared_ptr<const TexelMap>>& texels) {
  std::size_t faces = 0;
  bool any = false;
  for (const SceneObject& object : scene.objects) {
    faces += object.mesh->triangles.size();
    any = any || object.paint != nullptr;
  }
  const bool ours = my_->mesh != nullptr && faces == my_->mesh->triangles.size();
  if (!any && my_->painted.objects.empty()) return;
  my_->painted = any && ours ? scene : Scene{};
  my_->texels = texels;
  my_->choosePaint();
  my_->applyVisibility();
  my_->paint_stale = my_->dirty = true;
}

void SceneView::setColors(const ColorScales& scales) {
  if (scales == my_->scales) return;
  my_->scales = scales;
  for (std::size_t q = 0; q < kPaintQuantities; ++q) {
    const auto quantity = static_cast<PaintQuantity>(q);
    my_->paint.setScale(quantity, scaleOf(scales, std::string(name(layerOf(quantity)))));
  }
  my_->paint_stale = my_->slice_stale = my_->dirty = true;
}

std::optional<ValueRange> SceneView::shownRange(const std::string& thing) const {
  if (thing == "slice" && my_->on(Layer::slice) && my_->field && !my_->slicedMaterial())
    return my_->slice.range();
  const auto quantity = my_->shownPaint();
  const bool is_shown = quantity && thing == name(layerOf(*quantity));
  if (!is_shown || *quantity == PaintQuantity::color) return std::nullopt;
  return my_->paint.range(*quantity);
}

ValueRange SceneView::paintRange(PaintQuantity quantity) const {
  return my_->paint.range(quantity);
}

bool SceneView::hasPaint(PaintQuantity quantity) const {
  return my_->paint.has(quantity);
}

void SceneView::setBrush(const std::optional<BrushCursorState>& place) {
  if (place == my_->brush_place) return;
  my_->brush_place = place;
  my_->brush_stale = my_->front_dirty = true;
}

void SceneView::setMirror(const std::optional<MirrorState>& place) {
  if (place == my_->mirror_place) return;
  my_->mirror_place = place;
  place ? void(my_->mirror.emplace(*my_->scene, *place)) : my_->mirror.reset();
  my_->dirty = true;
}

void SceneView::setField(std::shared_ptr<const SurfaceField> field) {
  my_->field = std::move(field);
  my_->sample.reset();
  my_->iso_stale = my_->slice_stale = my_->band_stale = my_->nodes_stale = my_->brush_stale = true;
  if (my_->field) {
    const Box3 box = my_->gridBox();
    my_->outline->SetBounds(box.min()[0], box.max()[0], box.min()[1], box.max()[1], box.min()[2],
                            box.max()[2]);
  }
  my_->applyVisibility();
  my_->dirty = true;
}

void SceneView::setIso(double iso) {
  my_->iso_stale = my_->iso_stale || iso != my_->iso;
  my_->iso = iso;
  my_->dirty = true;
}

void SceneView::setSlices(const Slices& places, std::size_t selected) {
  if (places != my_->slice_places) my_->slice_stale = true;
  my_->slice_places = places;
  my_->selected_slice = selected;
  my_->dirty = true;
}

void SceneView::setClip(const std::optional<ClipPlane>& plane) {
  if (!plane)
    my_->clip.reset();
  else if (my_->clip)
    my_->clip->set(*plane);
  else
    my_->clip.emplace(*my_->scene, *my_->overlay, *plane);
  my_->dirty = true;
}

double SceneView::handleLength(bool of_slice) const {
  const auto& handle = of_slice ? my_->slice_handle : my_->clip;
  return handle ? handle->length() : 0;
}

std::optional<ClipPlane> SceneView::slicePlane() const {
  return my_->slicePlane();
}

void SceneView::setSliceHandle(bool on) {
  my_->has_slice_handle = on;
  my_->dirty = true;
}

void SceneView::setLine(const std::optional<std::pair<Vec3, Vec3>>& ends) {
  const vtkNew<vtkLineSource> line;
  line->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  if (ends) {
    line->SetPoint1(ends->first.x(), ends->first.y(), ends->first.z());
    line->SetPoint2(ends->second.x(), ends->second.y(), ends->second.z());
    line->Update();
    mapperOf(*my_->line).SetInputData(line->GetOutput());
  }
  my_->line->SetVisibility(ends.has_value());
  my_->front_dirty = true;
}

void SceneView::setBand(const std::optional<TouchBand>& band) {
  if (band == my_->band) return;
  my_->band = band;
  my_->band_stale = my_->slice_stale = my_->dirty = true;
  my_->applyVisibility();
}

void SceneView::setStability(const TriangleMesh* surface, const std::vector<float>& ratio) {
  my_->has_stability = surface != nullptr;
  if (surface) my_->stability.update(*surface, ratio);
  my_->applyVisibility();
  my_->dirty = true;
}

void SceneView::setAnnotations(const std::vector<Annotation>& annotations) {
  if (annotations == my_->annotated) return;
  my_->annotated = annotations;
  my_->annotations.set(annotations);
  my_->front_dirty = true;
}

void SceneView::setTipRadius(double radius) {
  my_->tool.setTipRadius(radius);
  my_->dirty = true;
}

void SceneView::setTool(const ToolSample& sample, const std::optional<Vec3>& nearest) {
  const bool first = !my_->sample.has_value();
  if (!first && my_->sample->tip == sample.tip && my_->sample->vcp == sample.vcp &&
      my_->sample->force == sample.force && my_->sample->surface == sample.surface &&
      my_->tool.nearest() == nearest)
    return;
  my_->sample = sample;
  my_->tool.update(sample, nearest);
  if (first) my_->applyVisibility();
  my_->nodes_stale = my_->front_dirty = true;
}

void SceneView::show(Layer layer, bool on) {
  std::set<Layer> layers = my_->layers;
  if (on)
    layers.insert(layer);
  else
    layers.erase(layer);
  showOnly(layers);
}

void SceneView::showOnly(const std::set<Layer>& layers) {
  if (layers.count(Layer::band) != my_->layers.count(Layer::band)) my_->slice_stale = true;
  my_->layers = layers;
  my_->choosePaint();
  my_->paint_stale = true;
  my_->applyVisibility();
  my_->dirty = true;
}

bool SceneView::shown(Layer layer) const {
  return my_->on(layer);
}

std::optional<Front> SceneView::frontAlong(const Ray& view_ray) const {
  if (!my_->field) return std::nullopt;
  std::optional<Ray> rest = view_ray;
  if (my_->clip) rest = behind(my_->clip->plane(), view_ray);
  if (rest && my_->on(Layer::slice)) // nothing is drawn in front of a slice's plane
    if (const auto hit = my_->slice.hitAlong(*my_->field, view_ray.origin, Ray(*rest), rest))
      return Front{Layer::slice, hit->point, hit->slice};
  return rest ? my_->surfaceAlong(*rest) : std::nullopt;
}

std::optional<Vec3> SceneView::vertexNear(const Ray& view_ray, const Ray& reach) const {
  if (!my_->mesh || !my_->field) return std::nullopt;
  const auto isHidden = [&](const Vec3& p) {
    if (my_->clip && (p - my_->clip->plane().origin).dot(my_->clip->plane().normal) > 0)
      return true;
    if (my_->on(Layer::slice) && my_->slice.hides(p, view_ray.origin)) return true;
    // Rounded by the field, the surface lies up to two voxels before a vertex.
    const bool parallel = (reach.direction - view_ray.direction).norm() < 1e-12;
    Ray sight = view_ray;
    if (parallel)
      sight.origin = p - (p - view_ray.origin).dot(view_ray.direction) * view_ray.direction;
    else
      sight.direction = (p - view_ray.origin).normalized();
    const auto front = frontAlong(sight);
    return front && (p - front->point).dot(sight.direction) > 2 * my_->field->grid.voxel;
  };
  constexpr std::size_t kMaxTried = 50; // a fine mesh has many
  for (const Vec3& p : verticesNear(*my_->mesh, view_ray, reach, kMaxTried))
    if (!isHidden(p)) return p;
  return std::nullopt;
}

void SceneView::setBackgroundStyle(const palette::BackgroundStyle& ground) {
  my_->setGround(ground);
}

const palette::BackgroundStyle& SceneView::backgroundStyle() const {
  return my_->ground;
}

void SceneView::setFigureParts(const std::optional<std::set<FigurePart>>& without) {
  my_->without = without;
  my_->brush_stale = my_->dirty = true;
}

void SceneView::showCube(bool on) {
  my_->axes->SetVisibility(!on);
  on ? void(my_->cube.emplace(*my_->corner)) : my_->cube.reset();
  my_->corner->SetUseFXAA(on); // few pixels, no cost
  my_->dirty = true;
}

std::optional<Vec3> SceneView::cubeSideAt(double x, double y) const {
  const double* port = my_->corner->GetViewport(); // viewport of the last picture
  if (!my_->cube || x > port[2] || y > port[3]) return std::nullopt;
  return patina::cubeSideAt(
      rayThrough(*my_->corner->GetActiveCamera(), x / port[2] - 0.5, y / port[3] - 0.5));
}

void SceneView::setHighlighted(const HoveredPart& hovered) {
  if (hovered == my_->hovered) return;
  my_->hovered = hovered;
  if (my_->cube) my_->cube->setHighlighted(hovered.cube_side);
  if (my_->clip) my_->clip->setHighlighted(hovered.of_slice ? std::nullopt : hovered.clip);
  my_->dirty = true;
}

void SceneView::setView(ViewPreset view) {
  turnCamera(my_->camera(), view);
  fit();
}

void SceneView::setInteracting(bool moving) {
  const bool shown = my_->coarseShown(), was = my_->moving;
  my_->moving = moving;
  if (moving) my_->makeCoarse();
  if (my_->coarse_made.valid() &&
      my_->coarse_made.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    mapperOf(*my_->coarse_actor).SetInputData(my_->coarse_made.get());
    my_->has_coarse = true;
  }
  my_->setHalfSize(moving);
  my_->dirty = my_->dirty || my_->coarseShown() != shown || was != moving;
}

void SceneView::setSmooth(bool on) {
  my_->setSmooth(on);
}

bool SceneView::keepsBodies() const {
  return my_->keepsBodies();
}

void SceneView::fit() {
  const Box3 box = my_->box();
  // Scalar bars are at the right edge; the rest of the picture is fitted.
  const bool tags = my_->mapShown() && my_->stability.hasTags();
  const double taken = my_->barShare() * (my_->bars() + (tags ? 0.7 : 0));
  const double aspect = my_->aspect() * (1 - taken);
  std::vector<Vec3> points = my_->outermost(box);
  resetCameraTo(my_->camera(), box.center(), points, aspect);
  my_->fitArrow(box, points, aspect);
  pan(my_->camera(), -0.5 * taken * my_->aspect(), 0);
  my_->dirty = true;
}

Box3 SceneView::extent() const {
  return my_->box();
}

bool SceneView::prepare() {
  my_->aimTool();
  if (my_->paint_stale) {
    my_->paint.prepare();
    my_->drawMesh();
    my_->paint_stale = false;
  }
  if (my_->brush_stale) {
    my_->brush.update(my_->without ? std::nullopt : my_->brush_place, my_->field.get());
    my_->brush_stale = false;
  }
  if (my_->iso_stale && my_->field && my_->on(Layer::iso)) {
    mapperOf(*my_->iso_actor).SetInputData(surfaceData(isoSurface(*my_->field, my_->iso)));
    my_->iso_stale = false;
  }
  if (my_->slice_stale && my_->sliceShown()) {
    std::optional<SliceMaterial> material;
    if (const auto channel = my_->slicedMaterial())
      material = SliceMaterial{&my_->painted, *channel, my_->paint.colors()};
    my_->slice.update(*my_->field, my_->slice_places, my_->bandShown() ? my_->band : std::nullopt,
                      material, scaleOf(my_->scales, "slice"));
    my_->slice_stale = false;
  }
  if (my_->band_stale && my_->bandShown()) {
    my_->band_layer.update(*my_->field, *my_->band);
    my_->band_stale = false;
  }
  if (my_->nodes_stale && my_->field && my_->sample && my_->on(Layer::nodes)) {
    my_->nodes.update(*my_->field, my_->sample->tip);
    my_->nodes_stale = false;
  }
  my_->cutAt();
  if (my_->mirror) my_->mirror->setBackgroundStyle(my_->ground);
  my_->placeSliceHandle();
  if (my_->clip) my_->clip->showHandle(!my_->without);
  if (my_->clip) my_->clip->prepare(my_->box(), my_->ground);
  const TextStyle letters = my_->letters();
  my_->band_layer.setTextStyle(letters);
  my_->tool.setTextStyle(letters);
  my_->annotations.setTextStyle(letters);
  setTextStyle(*my_->axes, letters);
  if (my_->cube) my_->cube->setBackgroundStyle(my_->ground);
  // Letters keep their size in small pictures; the corner leaves room for them at the axes.
  my_->tool.setCorner(my_->placeCorner(my_->cube ? ViewCube::kDistance : 5.2, 0.17, 8.5));
  my_->tool.faceCamera(my_->camera());
  my_->scale.update(my_->camera(), my_->size()[1], letters);
  my_->applyVisibility();
  return my_->finishFrame();
}

} // namespace patina
