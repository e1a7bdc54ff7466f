#include "visualization/view/scan_picture.h"

#include <array>

#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkLineSource.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>

#include "visualization/layers/scale_layer.h"
#include "visualization/surfaces/precise_points.h"
#include "visualization/surfaces/surface_data.h"
#include "visualization/values/palette.h"
#include "visualization/values/scalar_bar.h"
#include "visualization/view/camera.h"
#include "visualization/view/scene_furniture.h"

namespace patina {
namespace {

constexpr double kReach = 0.06; // of the drawn frustum [m]
constexpr double kAxis = 0.03;  // of the probe's drawn axes [m]
constexpr double kBall = 0.008; // radius, of the picture's height

vtkSmartPointer<vtkActor> lineActor(const palette::Color& color, double width) {
  auto actor = surfaceActor(color);
  actor->GetProperty()->SetLineWidth(static_cast<float>(width));
  actor->GetProperty()->LightingOff();
  return actor;
}

vtkSmartPointer<vtkPolyData> linesThrough(const std::vector<std::array<Vec3, 2>>& pairs) {
  const auto points = precisePoints();
  const vtkNew<vtkCellArray> lines;
  for (const auto& [from, to] : pairs) {
    lines->InsertNextCell(2);
    lines->InsertCellPoint(points->InsertNextPoint(from.data()));
    lines->InsertCellPoint(points->InsertNextPoint(to.data()));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  return data;
}

void setData(vtkActor& actor, vtkPolyData* data) {
  vtkPolyDataMapper::SafeDownCast(actor.GetMapper())->SetInputData(data);
}

std::array<Vec3, 4> frustumCorners(const DrawnCamera& camera) {
  const Vec3 half = kReach / 2 * Vec3(camera.wide, camera.high, 0);
  const auto at = [&](double x, double y) {
    return camera.picture_from_camera * Vec3(x * half.x(), y * half.y(), kReach);
  };
  return {at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)};
}

} // namespace

struct ScanPicture::Impl {
  vtkNew<vtkRenderer> scene, overlay, corner;
  vtkSmartPointer<vtkAxesActor> corner_axes = axesActor();
  palette::Ground ground = palette::kLight;
  PathLayer path{*scene, *overlay};
  HandleLayer handle{*overlay};
  ScaleLayer scale{*overlay};
  bool has_scale = false;
  vtkSmartPointer<vtkActor> mesh = surfaceActor(palette::kSurface);
  vtkSmartPointer<vtkActor> highlight = surfaceActor(palette::kTool);
  vtkSmartPointer<vtkActor> pale = surfaceActor(palette::kToolPale);
  vtkSmartPointer<vtkActor> frustum = lineActor(palette::kToolShaft, 1.6);
  vtkSmartPointer<vtkActor> shaft = lineActor(palette::kToolShaft, 3);
  vtkSmartPointer<vtkActor> ball = surfaceActor(palette::kTool);
  std::array<vtkSmartPointer<vtkActor>, 3> axes;
  vtkSmartPointer<vtkPolyData> mesh_data;
  std::vector<std::int32_t> vertex_of_point; // of the mesh
  bool has_values = false;
  Box3 mesh_box;
  std::optional<DrawnCamera> camera;
  std::optional<DrawnProbe> probe;
  CameraPlace drawn_from{};
  std::array<int, 2> drawn_size{};
  bool dirty = true;

  std::array<int, 2> size() const {
    auto* window = scene->GetRenderWindow();
    return window != nullptr ? std::array{window->GetSize()[0], window->GetSize()[1]}
                             : std::array{1, 1};
  }
  Lettering letters() const { return letteringOf(scene->GetRenderWindow(), ground); }
  std::vector<Vec3> outermost(bool with_camera) const {
    std::vector<Vec3> points;
    for (const Box3& box : {mesh_box, path.extent()})
      for (int i = 0; i < 8 && !box.isEmpty(); ++i)
        points.push_back(box.corner(static_cast<Box3::CornerType>(i)));
    if (camera && (with_camera || points.empty())) {
      points.push_back(camera->picture_from_camera.translation());
      for (const Vec3& edge : frustumCorners(*camera)) points.push_back(edge);
    }
    if (points.empty()) points = {Vec3::Constant(-0.05), Vec3::Constant(0.05)};
    return points;
  }
  void fit(bool with_camera);
  void sinkMesh();
  void sizeBall() {
    if (!probe) return;
    vtkCamera& eye = *scene->GetActiveCamera();
    const Vec3 tip = probe->picture_from_probe * probe->tip;
    const double away = (tip - Vec3(eye.GetPosition())).norm();
    ball->SetScale(kBall * 2 * away * std::tan(eye.GetViewAngle() * M_PI / 360));
  }
  void syncCorner() {
    vtkCamera& eye = *scene->GetActiveCamera();
    const Vec3 back = 5.2 * (Vec3(eye.GetPosition()) - Vec3(eye.GetFocalPoint())).normalized();
    vtkCamera* small = corner->GetActiveCamera();
    small->SetPosition(back.x(), back.y(), back.z());
    small->SetFocalPoint(0, 0, 0);
    small->SetViewUp(eye.GetViewUp());
    const auto [wide, high] = size();
    const double side = std::max(0.15 * high, 8. * letters().pixels);
    corner->SetViewport(0, 0, std::min(1., side / std::max(1, wide)),
                        std::min(1., side / std::max(1, high)));
    corner->ResetCameraClippingRange();
  }
};

ScanPicture::ScanPicture() : impl_(std::make_unique<Impl>()) {
  Impl& my = *impl_;
  setBackground(*my.scene, my.ground);
  addLights(*my.scene);
  const vtkNew<vtkSphereSource> ball;
  ball->SetRadius(1);
  ball->SetThetaResolution(24);
  ball->SetPhiResolution(16);
  ball->Update();
  setData(*my.ball, ball->GetOutput());
  for (std::size_t i = 0; i < 3; ++i) my.axes[i] = lineActor(kAxisColors[i], 3);
  for (const auto& actor : {my.mesh, my.highlight, my.pale, my.frustum}) my.scene->AddActor(actor);
  for (const auto& actor : {my.shaft, my.ball, my.axes[0], my.axes[1], my.axes[2]})
    my.overlay->AddActor(actor);
  my.overlay->SetLayer(1);
  my.overlay->InteractiveOff();
  my.overlay->SetActiveCamera(my.scene->GetActiveCamera());
  addLights(*my.overlay);
  my.corner->SetLayer(1);
  my.corner->InteractiveOff();
  my.corner->AddActor(my.corner_axes);
  for (const auto& each : {my.mesh, my.highlight, my.pale, my.frustum}) each->SetVisibility(false);
  setProbe(std::nullopt);
}

ScanPicture::~ScanPicture() = default;

void ScanPicture::attachTo(vtkRenderWindow& window) {
  window.SetNumberOfLayers(2);
  window.AddRenderer(impl_->scene);
  window.AddRenderer(impl_->overlay);
  window.AddRenderer(impl_->corner);
}

vtkRenderer& ScanPicture::renderer() {
  return *impl_->scene;
}

void ScanPicture::setMesh(std::shared_ptr<const TriangleMesh> mesh) {
  Impl& my = *impl_;
  my.mesh_box = mesh ? bounds(*mesh) : Box3();
  my.mesh->SetVisibility(mesh != nullptr);
  my.vertex_of_point.clear();
  my.mesh_data = mesh ? surfaceData(*mesh, smoothNormals(*mesh), my.vertex_of_point)
                      : vtkSmartPointer<vtkPolyData>::New();
  setData(*my.mesh, my.mesh_data);
  setMeshValues({});
}

void ScanPicture::setMeshValues(const std::vector<float>& values) {
  Impl& my = *impl_;
  my.has_values = !values.empty();
  my.dirty = true;
  my.mesh->GetMapper()->SetScalarVisibility(my.has_values);
  // Shine would shift colours that are to be read.
  my.mesh->GetProperty()->SetSpecular(my.has_values ? 0 : 0.16);
  if (!my.has_values) return;
  const vtkNew<vtkFloatArray> shown;
  for (const std::int32_t vertex : my.vertex_of_point)
    shown->InsertNextValue(values[static_cast<std::size_t>(vertex)]);
  my.mesh_data->GetPointData()->SetScalars(shown);
  my.mesh_data->Modified();
}

void ScanPicture::setHighlight(const std::shared_ptr<const TriangleMesh>& faces,
                               const std::shared_ptr<const TriangleMesh>& pale) {
  Impl& my = *impl_;
  for (const auto& [actor, mesh] : {std::pair{my.highlight, faces}, std::pair{my.pale, pale}}) {
    actor->SetVisibility(mesh != nullptr);
    setData(*actor, mesh ? surfaceData(*mesh) : vtkSmartPointer<vtkPolyData>::New());
  }
  my.dirty = true;
}

void ScanPicture::setPath(const DrawnPath& path) {
  impl_->path.setPath(path);
  impl_->dirty = true;
}

void ScanPicture::setMarks(const std::vector<DrawnMark>& marks) {
  impl_->path.setMarks(marks);
  impl_->dirty = true;
}

void ScanPicture::setCamera(const std::optional<DrawnCamera>& camera) {
  Impl& my = *impl_;
  my.camera = camera;
  my.frustum->SetVisibility(camera.has_value());
  my.dirty = true;
  if (!camera) return;
  const std::array<Vec3, 4> edge = frustumCorners(*camera);
  std::vector<std::array<Vec3, 2>> lines;
  for (std::size_t i = 0; i < 4; ++i) {
    lines.push_back({camera->picture_from_camera.translation(), edge[i]});
    lines.push_back({edge[i], edge[(i + 1) % 4]});
  }
  // A roof over the upper edge, which is that of small y.
  const Vec3 roof = edge[0] + 0.5 * (edge[1] - edge[0]) + 0.25 * (edge[0] - edge[3]);
  lines.push_back({edge[0], roof});
  lines.push_back({roof, edge[1]});
  setData(*my.frustum, linesThrough(lines));
}

void ScanPicture::setProbe(const std::optional<DrawnProbe>& probe) {
  Impl& my = *impl_;
  my.probe = probe;
  for (const auto& actor : {my.shaft, my.ball, my.axes[0], my.axes[1], my.axes[2]})
    actor->SetVisibility(probe.has_value());
  my.dirty = true;
  if (!probe) return;
  const Vec3 tip = probe->picture_from_probe * probe->tip;
  const Vec3 origin = probe->picture_from_probe.translation();
  my.ball->SetPosition(tip.x(), tip.y(), tip.z());
  setData(*my.shaft, linesThrough({{tip, origin}}));
  for (std::size_t i = 0; i < 3; ++i)
    setData(*my.axes[i],
            linesThrough({{origin, probe->picture_from_probe *
                                       (kAxis * Vec3::Unit(static_cast<Eigen::Index>(i)))}}));
}

void ScanPicture::setScale(bool on) {
  impl_->has_scale = on;
  impl_->dirty = true;
}

HandleLayer& ScanPicture::handle() {
  return impl_->handle;
}

void ScanPicture::setDirty() {
  impl_->dirty = true;
}

void ScanPicture::lookAtAll(const Vec3& up) {
  Impl& my = *impl_;
  vtkCamera& eye = *my.scene->GetActiveCamera();
  const Vec3 side = up.unitOrthogonal(), front = up.cross(side);
  const Vec3 from = 0.55 * side + 0.75 * front + 0.75 * up;
  eye.SetFocalPoint(0, 0, 0);
  eye.SetPosition(from.x(), from.y(), from.z());
  eye.SetViewUp(up.x(), up.y(), up.z());
  my.fit(my.mesh_box.isEmpty());
}

void ScanPicture::setGround(const palette::Ground& ground) {
  Impl& my = *impl_;
  my.ground = ground;
  setBackground(*my.scene, ground);
  for (const auto& thin : {my.frustum, my.shaft})
    thin->GetProperty()->SetColor(palette::forVtk(ground.shaft));
  my.dirty = true;
}

void ScanPicture::setView(ViewPreset view) {
  turnCamera(*impl_->scene->GetActiveCamera(), view);
  fit();
}

void ScanPicture::fit() {
  impl_->fit(false);
}

void ScanPicture::Impl::fit(bool with_camera) {
  Impl& my = *this;
  const auto [wide, high] = my.size();
  // The scalar bar stands at the right edge: what is fitted goes to its left.
  const double taken = my.path.hasBar() ? scalarBarShare(wide, my.letters()) : 0;
  const std::vector<Vec3> points = my.outermost(with_camera);
  Box3 box;
  for (const Vec3& point : points) box.extend(point);
  const double aspect = static_cast<double>(wide) / std::max(1, high);
  fitCamera(*my.scene->GetActiveCamera(), box.center(), points, aspect * (1 - taken));
  pan(*my.scene->GetActiveCamera(), -0.5 * taken * aspect, 0);
  my.dirty = true;
}

// What presses lies a little below the surface, and is seen all the same. A depth offset would be
// one of units that differ from window to window.
void ScanPicture::Impl::sinkMesh() {
  if (mesh_box.isEmpty()) return;
  const Vec3 behind = 0.01 * mesh_box.diagonal().norm() * viewDirection(*scene->GetActiveCamera());
  mesh->SetPosition(behind.x(), behind.y(), behind.z());
  const Vec3 before = 0.75 * behind; // the mesh, and behind the path
  for (const auto& actor : {highlight, pale})
    actor->SetPosition(before.x(), before.y(), before.z());
}

std::optional<double> ScanPicture::timeAt(double x, double y, double reach) const {
  return impl_->path.timeAt(*impl_->scene, x, y, reach);
}

bool ScanPicture::prepare() {
  Impl& my = *impl_;
  placeScalarBar(my.path.bar(), 0, my.letters(), my.size());
  setLettering(*my.corner_axes, my.letters());
  my.scale.setVisible(my.has_scale && !(my.mesh_box.isEmpty() && my.path.extent().isEmpty()));
  my.scale.update(*my.scene->GetActiveCamera(), my.size()[1], my.letters());
  if (my.has_values && my.path.colors() != nullptr) {
    my.mesh->GetMapper()->SetLookupTable(my.path.colors());
    my.mesh->GetMapper()->UseLookupTableScalarRangeOn();
  }
  my.sizeBall();
  my.handle.prepare();
  my.syncCorner();
  my.sinkMesh();
  my.scene->ResetCameraClippingRange();
  const CameraPlace place = placeOf(*my.scene->GetActiveCamera());
  const bool changed = my.dirty || place != my.drawn_from || my.size() != my.drawn_size;
  my.drawn_from = place;
  my.drawn_size = my.size();
  my.dirty = false;
  return changed;
}

} // namespace patina
