#include "visualization/view/scene_view_parts.h"

#include <algorithm>
#include <cmath>

#include <vtkCamera.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTransform.h>

#include "scene/surface_pick.h"
#include "visualization/surfaces/coarse_surface.h"
#include "visualization/surfaces/surface_data.h"
#include "visualization/values/scalar_bar.h"
#include "visualization/view/camera.h"

namespace patina {

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
  const bool distance_bar = on(Layer::slice) && field != nullptr && !slicedMaterial();
  return (distance_bar ? 1 : 0) + (mapShown() ? 1 : 0) + (paint_bar ? 1 : 0);
}

double SceneView::Impl::barShare() const {
  return scalarBarShare(size()[0], letters());
}

void SceneView::Impl::choosePaint() {
  const auto before = slicedMaterial();
  paint.set(painted, texels);
  paint.show(shownPaint());
  if (slicedMaterial() || before) slice_stale = true;
}

// The mesh is kept by whoever makes it: the view may have another one before it is done.
void SceneView::Impl::makeCoarse() {
  constexpr std::size_t kMany = 20'000;
  constexpr int kCells = 48; // some 14,000 triangles
  if (mesh && mesh->triangles.size() > kMany && !coarse_made.valid() && !has_coarse)
    coarse_made = std::async(std::launch::async,
                             [shown = mesh] { return surfaceData(coarsened(*shown, kCells)); });
}

// Objects whose paint is shown are the paint layer's.
void SceneView::Impl::drawMesh() {
  std::vector<bool> out;
  for (std::size_t object = 0; object < painted.objects.size(); ++object)
    out.push_back(paint.draws(object));
  if (std::none_of(out.begin(), out.end(), [](bool o) { return o; })) out.clear();
  if (out == left_out) return;
  left_out = out;
  auto* mapper = vtkPolyDataMapper::SafeDownCast(mesh_actor->GetMapper());
  if (!mesh || left_out.empty()) {
    mapper->SetInputData(mesh ? surfaceData(*mesh) : vtkSmartPointer<vtkPolyData>::New());
    return;
  }
  TriangleMesh rest;
  rest.positions = mesh->positions;
  auto next = mesh->triangles.begin();
  for (std::size_t object = 0; object < painted.objects.size(); ++object) {
    const auto end =
        next + static_cast<std::ptrdiff_t>(painted.objects[object].mesh->triangles.size());
    if (!left_out[object]) rest.triangles.insert(rest.triangles.end(), next, end);
    next = end;
  }
  mapper->SetInputData(surfaceData(rest));
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
  // At 0 the iso-surface is the mesh: one of them is seen, for two would fight.
  const bool same = field && std::abs(iso) < 0.5 * field->grid.voxel;
  const bool as_iso = same && on(Layer::iso) && !map && !shownPaint();
  const bool plain = on(Layer::mesh) && mesh != nullptr && !map && !as_iso;
  mesh_actor->SetVisibility(plain && !coarseShown());
  coarse_actor->SetVisibility(plain && coarseShown());
  iso_actor->SetVisibility(on(Layer::iso) && field != nullptr && (as_iso || !same));
  extent_actor->SetVisibility(on(Layer::extent) && field != nullptr);
  band_layer.setVisible(shellShown(), bandShown() && (!map || on(Layer::slice)));
  slice.setVisible(on(Layer::slice) && field != nullptr);
  tool.setVisible(on(Layer::tip) && sample.has_value());
  scale.setVisible(on(Layer::scale) && (mesh != nullptr || field != nullptr));
  nodes.setVisible(on(Layer::nodes) && field != nullptr);
  for (vtkActor* actor : {mesh_actor.Get(), iso_actor.Get(), &stability.surface()})
    actor->GetProperty()->SetEdgeVisibility(on(Layer::wireframe));
  // Over the mesh the iso-surface is a shell that one sees through; alone it is the surface.
  const bool shell = !as_iso && (map || shownPaint() || (on(Layer::mesh) && mesh != nullptr));
  iso_actor->GetProperty()->SetOpacity(shell ? 0.38 : 1.0);
  iso_actor->GetProperty()->SetBackfaceCulling(shell);
}

// Surfaces in front of the slice would hide it: the half towards the camera is cut away. So is what
// lies ahead of the clip plane.
void SceneView::Impl::cutAt() {
  std::vector<vtkPlane*> planes;
  if (on(Layer::slice) && field != nullptr) {
    vtkPlane& plane = slice.plane();
    const Vec3 eye(scene->GetActiveCamera()->GetPosition());
    const Vec3 normal = Vec3::Unit(place.axis);
    const bool keeps_positive = (eye - Vec3(plane.GetOrigin())).dot(normal) < 0;
    Vec3 inward = keeps_positive ? normal : Vec3(-normal);
    plane.SetNormal(inward.data());
    // A hair behind the slice: the rims of what is cut would shine through its lines.
    Vec3 origin(plane.GetOrigin());
    origin[place.axis] = slice.position() + (keeps_positive ? 1 : -1) * 0.35 * field->grid.voxel;
    plane.SetOrigin(origin.data());
    dirty = dirty || keeps_positive != cut_keeps_positive;
    cut_keeps_positive = keeps_positive;
    planes.push_back(&plane);
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
  const double away = cube ? ViewCube::kDistance : 5.2;
  Vec3 back = (Vec3(camera->GetPosition()) - Vec3(camera->GetFocalPoint())).normalized() * away;
  vtkCamera* small = corner->GetActiveCamera();
  small->SetPosition(back.data());
  small->SetFocalPoint(0, 0, 0);
  small->SetViewUp(camera->GetViewUp());
  // Letters do not shrink with the picture: there is room for them beside the axes.
  const auto [wide, high] = size();
  const double side = std::max(0.17 * high, 8.5 * letters().pixels);
  tool.setCorner(side);
  corner->SetViewport(0, 0, std::min(1.0, side / std::max(1, wide)),
                      std::min(1.0, side / std::max(1, high)));
  corner->ResetCameraClippingRange();
}

} // namespace patina
