#include "visualization/view/scan_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>

#include "visualization/layers/scale_layer.h"
#include "visualization/surfaces/precise_points.h"
#include "visualization/surfaces/surface_data.h"
#include "visualization/values/scalar_bar.h"
#include "visualization/values/scene_setup.h"
#include "visualization/view/picture_stage.h"

namespace patina {
namespace {

constexpr double kFrustumDepth = 0.06; // depth of the drawn frustum [m]
constexpr double kAxis = 0.03;         // length of the probe's drawn axes [m]
constexpr double kBallShare = 0.008;   // radius in picture heights

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

std::array<Vec3, 4> frustumCorners(const DrawnCamera& camera) {
  const Vec3 half = kFrustumDepth / 2 * Vec3(camera.wide, camera.high, 0);
  const auto at = [&](double x, double y) {
    return camera.picture_from_camera * Vec3(x * half.x(), y * half.y(), kFrustumDepth);
  };
  return {at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)};
}

} // namespace

struct ScanPicture::Impl : PictureStage {
  PathLayer path{*scene, *overlay};
  HandleLayer handle{*overlay};
  ScaleLayer scale{*overlay};
  bool has_scale = false;
  vtkSmartPointer<vtkActor> mesh = surfaceActor(palette::kSurface);
  vtkSmartPointer<vtkActor> highlight = surfaceActor(palette::kTool);
  vtkSmartPointer<vtkActor> pale = surfaceActor(palette::kToolPale);
  vtkSmartPointer<vtkActor> frustum = lineActor(palette::kToolShaft, 1.6);
  vtkSmartPointer<vtkActor> shaft = lineActor(palette::kToolShaft, 3);
  vtkSmartPointer<vtkActor> ball;
  std::array<vtkSmartPointer<vtkActor>, 3> probe_axes;
  vtkSmartPointer<vtkPolyData> mesh_data;
  std::vector<std::int32_t> vertex_of_point; // vertex of the mesh
  bool has_values = false;
  Box3 mesh_box;
  std::optional<DrawnCamera> drawn_camera;
  std::optional<DrawnProbe> probe;

  std::vector<Vec3> outermost(bool with_camera) const {
    std::vector<Vec3> points;
    for (const Box3& box : {mesh_box, path.extent()})
      for (int i = 0; i < 8 && !box.isEmpty(); ++i)
        points.push_back(box.corner(static_cast<Box3::CornerType>(i)));
    if (drawn_camera && (with_camera || points.empty())) {
      points.push_back(drawn_camera->picture_from_camera.translation());
      for (const Vec3& edge : frustumCorners(*drawn_camera)) points.push_back(edge);
    }
    if (points.empty()) points = {Vec3::Constant(-0.05), Vec3::Constant(0.05)};
    return points;
  }
  void fit(bool with_camera);
  void sinkMesh();
  void sizeBall() {
    if (!probe) return;
    const Vec3 tip = probe->picture_from_probe * probe->tip;
    const double away = (tip - Vec3(camera().GetPosition())).norm();
    ball->SetScale(kBallShare * 2 * away * std::tan(camera().GetViewAngle() * M_PI / 360));
  }
};

ScanPicture::ScanPicture() : my_(std::make_unique<Impl>()) {
  const vtkNew<vtkSphereSource> ball;
  ball->SetRadius(1);
  ball->SetThetaResolution(24);
  ball->SetPhiResolution(16);
  my_->ball = surfaceActor(*ball, palette::kTool);
  for (std::size_t i = 0; i < 3; ++i) my_->probe_axes[i] = lineActor(kAxisColors[i], 3);
  for (const auto& actor : {my_->mesh, my_->highlight, my_->pale, my_->frustum})
    my_->scene->AddActor(actor);
  for (const auto& actor :
       {my_->shaft, my_->ball, my_->probe_axes[0], my_->probe_axes[1], my_->probe_axes[2]})
    my_->overlay->AddActor(actor);
  my_->setUp();
  for (const auto& each : {my_->mesh, my_->highlight, my_->pale, my_->frustum})
    each->SetVisibility(false);
  setProbe(std::nullopt);
}

ScanPicture::~ScanPicture() = default;

void ScanPicture::attachTo(vtkRenderWindow& window) {
  my_->attachTo(window);
}

vtkRenderer& ScanPicture::renderer() {
  return *my_->scene;
}

void ScanPicture::setMesh(std::shared_ptr<const TriangleMesh> mesh) {
  my_->mesh_box = mesh ? bounds(*mesh) : Box3();
  my_->mesh->SetVisibility(mesh != nullptr);
  my_->vertex_of_point.clear();
  my_->mesh_data = mesh ? surfaceData(*mesh, smoothNormals(*mesh), my_->vertex_of_point)
                        : vtkSmartPointer<vtkPolyData>::New();
  mapperOf(*my_->mesh).SetInputData(my_->mesh_data);
  setMeshValues({});
}

void ScanPicture::setMeshValues(const std::vector<float>& values) {
  my_->has_values = !values.empty();
  my_->dirty = true;
  my_->mesh->GetMapper()->SetScalarVisibility(my_->has_values);
  // Specular light would change colours that are read against a scale.
  my_->mesh->GetProperty()->SetSpecular(my_->has_values ? 0 : 0.16);
  if (!my_->has_values) return;
  const vtkNew<vtkFloatArray> shown;
  for (const std::int32_t vertex : my_->vertex_of_point)
    shown->InsertNextValue(values[static_cast<std::size_t>(vertex)]);
  my_->mesh_data->GetPointData()->SetScalars(shown);
  my_->mesh_data->Modified();
}

void ScanPicture::setHighlight(const std::shared_ptr<const TriangleMesh>& faces,
                               const std::shared_ptr<const TriangleMesh>& pale) {
  for (const auto& [actor, mesh] : {std::pair{my_->highlight, faces}, std::pair{my_->pale, pale}}) {
    actor->SetVisibility(mesh != nullptr);
    mapperOf(*actor).SetInputData(mesh ? surfaceData(*mesh) : vtkSmartPointer<vtkPolyData>::New());
  }
  my_->dirty = true;
}

void ScanPicture::setPath(const DrawnPath& path) {
  my_->path.setPath(path);
  my_->dirty = true;
}

void ScanPicture::setMarks(const std::vector<DrawnMark>& marks) {
  my_->path.setMarks(marks);
  my_->dirty = true;
}

void ScanPicture::setCamera(const std::optional<DrawnCamera>& camera) {
  my_->drawn_camera = camera;
  my_->frustum->SetVisibility(camera.has_value());
  my_->dirty = true;
  if (!camera) return;
  const std::array<Vec3, 4> edge = frustumCorners(*camera);
  std::vector<std::array<Vec3, 2>> lines;
  for (std::size_t i = 0; i < 4; ++i) {
    lines.push_back({camera->picture_from_camera.translation(), edge[i]});
    lines.push_back({edge[i], edge[(i + 1) % 4]});
  }
  // A roof over the upper edge, the one of small y.
  const Vec3 roof = edge[0] + 0.5 * (edge[1] - edge[0]) + 0.25 * (edge[0] - edge[3]);
  lines.push_back({edge[0], roof});
  lines.push_back({roof, edge[1]});
  mapperOf(*my_->frustum).SetInputData(linesThrough(lines));
}

void ScanPicture::setProbe(const std::optional<DrawnProbe>& probe) {
  my_->probe = probe;
  for (const auto& actor :
       {my_->shaft, my_->ball, my_->probe_axes[0], my_->probe_axes[1], my_->probe_axes[2]})
    actor->SetVisibility(probe.has_value());
  my_->dirty = true;
  if (!probe) return;
  const Vec3 tip = probe->picture_from_probe * probe->tip;
  const Vec3 origin = probe->picture_from_probe.translation();
  my_->ball->SetPosition(tip.x(), tip.y(), tip.z());
  mapperOf(*my_->shaft).SetInputData(linesThrough({{tip, origin}}));
  for (std::size_t i = 0; i < 3; ++i)
    mapperOf(*my_->probe_axes[i])
        .SetInputData(
            linesThrough({{origin, probe->picture_from_probe *
                                       (kAxis * Vec3::Unit(static_cast<Eigen::Index>(i)))}}));
}

void ScanPicture::setScale(bool on) {
  my_->has_scale = on;
  my_->dirty = true;
}

HandleLayer& ScanPicture::handle() {
  return my_->handle;
}

void ScanPicture::setDirty() {
  my_->dirty = true;
}

void ScanPicture::resetCamera(const Vec3& up) {
  vtkCamera& eye = my_->camera();
  const Vec3 side = up.unitOrthogonal(), front = up.cross(side);
  const Vec3 from = 0.55 * side + 0.75 * front + 0.75 * up;
  eye.SetFocalPoint(0, 0, 0);
  eye.SetPosition(from.x(), from.y(), from.z());
  eye.SetViewUp(up.x(), up.y(), up.z());
  my_->fit(my_->mesh_box.isEmpty());
}

void ScanPicture::setBackgroundStyle(const palette::BackgroundStyle& ground) {
  my_->setGround(ground);
  for (const auto& thin : {my_->frustum, my_->shaft})
    thin->GetProperty()->SetColor(palette::forVtk(ground.shaft));
}

void ScanPicture::setView(ViewPreset view) {
  turnCamera(my_->camera(), view);
  fit();
}

void ScanPicture::fit() {
  my_->fit(false);
}

void ScanPicture::Impl::fit(bool with_camera) {
  const int wide = std::max(1, size()[0]), high = std::max(1, size()[1]);
  // The scalar bar is at the right edge; the rest of the picture is fitted.
  const double taken = path.hasBar() ? scalarBarShare(wide, letters()) : 0;
  const std::vector<Vec3> points = outermost(with_camera);
  Box3 box;
  for (const Vec3& point : points) box.extend(point);
  const double aspect = static_cast<double>(wide) / high;
  resetCameraTo(camera(), box.center(), points, aspect * (1 - taken));
  pan(camera(), -0.5 * taken * aspect, 0);
  dirty = true;
}

// Moves the mesh slightly backwards, so that a path pressed below the surface stays visible. VTK's
// depth offset has units that differ between windows.
void ScanPicture::Impl::sinkMesh() {
  if (mesh_box.isEmpty()) return;
  const Vec3 behind = 0.01 * mesh_box.diagonal().norm() * viewDirection(camera());
  mesh->SetPosition(behind.x(), behind.y(), behind.z());
  const Vec3 before = 0.75 * behind; // between the mesh and the path
  for (const auto& actor : {highlight, pale})
    actor->SetPosition(before.x(), before.y(), before.z());
}

std::optional<DrawnSample> ScanPicture::sampleAt(double x, double y, double reach) const {
  return my_->path.sampleAt(*my_->scene, x, y, reach);
}

std::optional<ValueRange> ScanPicture::valueRange() const {
  if (my_->path.colors() == nullptr) return std::nullopt;
  const double* range = my_->path.colors()->GetRange();
  return ValueRange{range[0], range[1]};
}

const std::string& ScanPicture::pathTitle() const {
  return my_->path.title();
}

bool ScanPicture::prepare() {
  placeScalarBar(my_->path.bar(), 0, my_->letters(), my_->size());
  setTextStyle(*my_->axes, my_->letters());
  my_->scale.setVisible(my_->has_scale &&
                        !(my_->mesh_box.isEmpty() && my_->path.extent().isEmpty()));
  my_->scale.update(my_->camera(), my_->size()[1], my_->letters());
  if (my_->has_values && my_->path.colors() != nullptr) {
    my_->mesh->GetMapper()->SetLookupTable(my_->path.colors());
    my_->mesh->GetMapper()->UseLookupTableScalarRangeOn();
  }
  my_->sizeBall();
  my_->handle.prepare();
  my_->placeCorner(5.2, 0.15, 8);
  my_->sinkMesh();
  return my_->finishFrame();
}

} // namespace patina
