#include "visualization/layers/clip_layer.h"

#include <algorithm>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkConeSource.h>
#include <vtkCylinderSource.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>

#include "core/decompose.h"
#include "visualization/surfaces/precise_points.h"
#include "visualization/values/scene_setup.h"

namespace patina {
namespace {

// Fractions of the arrow's length.
constexpr double kHead = 0.26, kHeadRadius = 0.10, kShaftRadius = 0.022, kBallRadius = 0.09;
constexpr double kNear = 0.12;    // max distance from an axis at which the normal snaps to it
constexpr double kPicture = 0.40; // arrow length in halves of the picture's height
constexpr double kEndOn = 0.94; // cosine to the view ray above which the arrow points at the viewer
const double kSnap = std::cos(4 * M_PI / 180);

// Parameter along the plane's normal through its origin that is nearest to the view ray.
double alongNormal(const ClipPlane& plane, const Ray& view_ray) {
  const Vec3 off = plane.origin - view_ray.origin;
  const double slant = plane.normal.dot(view_ray.direction);
  return (slant * off.dot(view_ray.direction) - off.dot(plane.normal)) /
         std::max(1e-9, 1 - slant * slant);
}

double distanceTo(const Ray& view_ray, const Vec3& point) {
  const Vec3 off = point - view_ray.origin;
  return (off - off.dot(view_ray.direction) * view_ray.direction).norm();
}

Vec3 snapped(const Vec3& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  if (std::abs(normal[axis]) < kSnap) return normal;
  return normal[axis] > 0 ? Vec3::Unit(axis) : Vec3(-Vec3::Unit(axis));
}

vtkSmartPointer<vtkActor> handleActor(vtkPolyDataAlgorithm& source) {
  auto actor = surfaceActor(source, palette::kIso);
  actor->GetProperty()->SetAmbient(0.4);
  return actor;
}

// Corners, in order, of the part of the plane inside the box.
std::vector<Vec3> rimOf(const ClipPlane& plane, const Box3& box) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      if ((i >> axis & 1) != 0) continue;
      const Vec3 a = box.corner(static_cast<Box3::CornerType>(i));
      const Vec3 b = box.corner(static_cast<Box3::CornerType>(i | 1 << axis));
      const double at_a = (a - plane.origin).dot(plane.normal);
      const double at_b = (b - plane.origin).dot(plane.normal);
      if ((at_a > 0) != (at_b > 0)) corners.emplace_back(a + at_a / (at_a - at_b) * (b - a));
    }
  if (corners.empty()) return corners;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& corner : corners) middle += corner / static_cast<double>(corners.size());
  const Vec3 u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
  const auto angle = [&](const Vec3& p) {
    return std::atan2((p - middle).dot(v), (p - middle).dot(u));
  };
  std::sort(corners.begin(), corners.end(),
            [&](const Vec3& a, const Vec3& b) { return angle(a) < angle(b); });
  return corners;
}

} // namespace

std::optional<ClipPart> clipPartAt(const ClipPlane& plane, double length, const Ray& view_ray) {
  const double along = std::clamp(alongNormal(plane, view_ray), 0., length);
  if (distanceTo(view_ray, plane.origin + length * plane.normal) < kNear * length)
    return ClipPart::tilt;
  if (distanceTo(view_ray, plane.origin + along * plane.normal) > kNear * length)
    return std::nullopt;
  return along > (1 - kHead) * length ? ClipPart::tilt : ClipPart::shift;
}

ClipPlane clipShifted(const ClipPlane& plane, const Ray& from, const Ray& to, const Vec3& up) {
  double moved = 0;
  if (std::abs(plane.normal.dot(to.direction)) < kEndOn) {
    moved = alongNormal(plane, to) - alongNormal(plane, from);
  } else {
    const auto through = [&](const Ray& ray) { // at the plane's depth
      const double depth = (plane.origin - ray.origin).dot(ray.direction);
      return Vec3(ray.origin + depth * ray.direction);
    };
    moved = (through(to) - through(from)).dot(up);
  }
  return {plane.origin + moved * plane.normal, plane.normal};
}

ClipPlane clipTilted(const ClipPlane& plane, double length, const Ray& to) {
  // Intersection of the view ray with the sphere of the arrow's head, or the sphere's silhouette if
  // it misses.
  const Vec3 off = to.origin - plane.origin;
  const double middle = -off.dot(to.direction);
  const Vec3 nearest = off + middle * to.direction;
  const double half = length * length - nearest.squaredNorm();
  const Vec3 head = half > 0 ? Vec3(nearest - std::sqrt(half) * to.direction) : nearest;
  if (!(head.norm() > 0)) return plane;
  return {plane.origin, snapped(head.normalized())};
}

std::optional<Ray> behind(const ClipPlane& plane, const Ray& view_ray) {
  const double ahead = (view_ray.origin - plane.origin).dot(plane.normal);
  if (ahead <= 0) return view_ray;
  const double falls = -view_ray.direction.dot(plane.normal);
  if (!(falls > 1e-12)) return std::nullopt;
  return Ray{view_ray.origin + ahead / falls * view_ray.direction, view_ray.direction};
}

ClipLayer::ClipLayer(vtkRenderer& scene, vtkRenderer& overlay, const ClipPlane& plane)
    : scene_(scene), overlay_(overlay), cut_(vtkSmartPointer<vtkPlane>::New()),
      outline_(vtkSmartPointer<vtkPolyData>::New()), rim_(vtkSmartPointer<vtkActor>::New()) {
  const vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(outline_);
  rim_->SetMapper(mapper);
  rim_->GetProperty()->LightingOff();
  rim_->GetProperty()->SetLineWidth(1.5);
  // Along y with length 1, as VTK's cylinder.
  const vtkNew<vtkSphereSource> ball;
  ball->SetRadius(kBallRadius);
  ball->SetThetaResolution(24);
  ball->SetPhiResolution(16);
  ball_ = handleActor(*ball);
  const vtkNew<vtkCylinderSource> shaft;
  shaft->SetRadius(kShaftRadius);
  shaft->SetHeight(1 - kHead);
  shaft->SetCenter(0, 0.5 * (1 - kHead), 0);
  shaft->SetResolution(16);
  shaft_ = handleActor(*shaft);
  const vtkNew<vtkConeSource> head;
  head->SetDirection(0, 1, 0);
  head->SetHeight(kHead);
  head->SetRadius(kHeadRadius);
  head->SetCenter(0, 1 - 0.5 * kHead, 0);
  head->SetResolution(24);
  head_ = handleActor(*head);
  scene_.AddActor(rim_);
  for (const auto& actor : {ball_, shaft_, head_}) overlay_.AddActor(actor);
  set(plane);
}

ClipLayer::~ClipLayer() {
  scene_.RemoveActor(rim_);
  for (const auto& actor : {ball_, shaft_, head_}) overlay_.RemoveActor(actor);
}

void ClipLayer::set(const ClipPlane& plane) {
  plane_ = plane;
  Vec3 origin = plane.origin, kept = -plane.normal;
  cut_->SetOrigin(origin.data());
  cut_->SetNormal(kept.data());
}

double ClipLayer::length() const {
  vtkCamera& camera = *overlay_.GetActiveCamera();
  const double depth = (plane_.origin - Vec3(camera.GetPosition())).dot(viewDirection(camera));
  const double half = camera.GetParallelProjection() != 0
                          ? camera.GetParallelScale()
                          : std::max(0., depth) * std::tan(camera.GetViewAngle() * M_PI / 360);
  return kPicture * half;
}

void ClipLayer::setHighlighted(const std::optional<ClipPart>& part) {
  const auto color = [&](ClipPart of) { return part == of ? palette::kTool : palette::kIso; };
  for (const auto& actor : {ball_, shaft_})
    actor->GetProperty()->SetColor(palette::forVtk(color(ClipPart::shift)));
  head_->GetProperty()->SetColor(palette::forVtk(color(ClipPart::tilt)));
}

void ClipLayer::showHandle(bool on) {
  for (const auto& actor : {ball_, shaft_, head_}) actor->SetVisibility(on);
}

void ClipLayer::prepare(const Box3& box, const palette::BackgroundStyle& ground) {
  const double size = length();
  Pose handle = Pose::Identity();
  handle.linear() = size * rotationFromTo(Vec3::UnitY(), plane_.normal).toRotationMatrix();
  handle.translation() = plane_.origin;
  for (const auto& actor : {ball_, shaft_, head_}) place(*actor, handle);
  const auto points = precisePoints();
  const vtkNew<vtkCellArray> lines;
  const std::vector<Vec3> rim = rimOf(plane_, box);
  if (!rim.empty()) {
    lines->InsertNextCell(static_cast<vtkIdType>(rim.size()) + 1);
    for (const Vec3& corner : rim) lines->InsertCellPoint(points->InsertNextPoint(corner.data()));
    lines->InsertCellPoint(0);
  }
  outline_->SetPoints(points);
  outline_->SetLines(lines);
  outline_->Modified();
  rim_->GetProperty()->SetColor(palette::forVtk(ground.shaft));
}

} // namespace patina
