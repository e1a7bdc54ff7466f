#include "visualization/layers/handle_layer.h"

#include <algorithm>
#include <cmath>

#include <vtkArrowSource.h>
#include <vtkProperty.h>
#include <vtkRegularPolygonSource.h>
#include <vtkSphereSource.h>

#include "visualization/values/camera.h"
#include "visualization/values/scene_setup.h"

namespace patina {
namespace {

constexpr double kArrow = 1.45, kBall = 0.12;  // in radii of the rings
constexpr double kReach = 0.14;                // max distance for picking, in radii
constexpr double kShare = 0.34;                // radius in halves of the picture's height
constexpr double kEdgeOn = 0.7, kHidden = 0.9; // cosines between axis and view ray

bool turns(HandlePart part) {
  return part >= HandlePart::turn_x;
}
Vec3 axisOf(HandlePart part) {
  return Vec3::Unit((static_cast<int>(part) - 1) % 3);
}

double distanceFromSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double t =
      way.squaredNorm() > 0 ? std::clamp((p - a).dot(way) / way.squaredNorm(), 0., 1.) : 0.;
  return (p - a - t * way).norm();
}

// Direction of a ring seen edge-on, in the view plane.
Vec3 edgeOf(const Vec3& axis, const Vec3& back) {
  const Vec3 along = axis.cross(back);
  // Opposite to the arrow that it would cover.
  return along.sum() > 0 ? Vec3(-along.normalized()) : Vec3(along.normalized());
}

vtkSmartPointer<vtkActor> partActor(vtkPolyDataAlgorithm& source, const palette::Color& color) {
  auto actor = surfaceActor(source, color);
  actor->GetProperty()->SetLineWidth(3);
  actor->GetProperty()->SetAmbient(0.5);
  return actor;
}

} // namespace

std::optional<HandlePart> partAt(const HandleView& view, const Vec3& point) {
  const Vec3 p = (point - view.middle) / view.radius;
  if (p.norm() < 1.3 * kBall) return HandlePart::free;
  std::optional<HandlePart> best;
  double nearest = kReach;
  const auto consider = [&](HandlePart part, double distance) {
    if (distance >= nearest) return;
    nearest = distance;
    best = part;
  };
  for (const HandlePart part : {HandlePart::shift_x, HandlePart::shift_y, HandlePart::shift_z}) {
    const Vec3 axis = axisOf(part);
    if (std::abs(axis.dot(view.back)) > kHidden) continue;
    const Vec3 flat = axis - axis.dot(view.back) * view.back;
    consider(part, distanceFromSegment(p, kBall * flat, kArrow * flat));
  }
  for (const HandlePart part : {HandlePart::turn_x, HandlePart::turn_y, HandlePart::turn_z}) {
    const Vec3 axis = axisOf(part);
    if (std::abs(axis.dot(view.back)) > kEdgeOn)
      consider(part, std::abs(p.norm() - 1));
    else
      consider(part, distanceFromSegment(p, 2 * kBall * edgeOf(axis, view.back),
                                         edgeOf(axis, view.back)));
  }
  return best;
}

Pose handleMotion(const HandleView& view, HandlePart part, const Vec3& from, const Vec3& to) {
  Pose motion = Pose::Identity();
  const Vec3 moved = to - from;
  if (part == HandlePart::free) {
    motion.translation() = moved;
    return motion;
  }
  const Vec3 axis = axisOf(part);
  if (!turns(part)) {
    const Vec3 flat = axis - axis.dot(view.back) * view.back;
    motion.translation() = moved.dot(flat) / flat.squaredNorm() * axis;
    return motion;
  }
  double angle = 0;
  if (std::abs(axis.dot(view.back)) > kEdgeOn) {
    const Vec3 a = from - view.middle, b = to - view.middle;
    angle = std::atan2(a.cross(b).dot(view.back), a.dot(b));
    if (axis.dot(view.back) < 0) angle = -angle;
  } else {
    // The nearest point of the ring follows the pointer.
    const Vec3 tangent = axis.cross(view.back);
    angle = moved.dot(tangent) / (view.radius * tangent.squaredNorm());
  }
  const Eigen::AngleAxisd turn(angle, axis);
  motion.linear() = turn.toRotationMatrix();
  motion.translation() = view.middle - motion.linear() * view.middle;
  return motion;
}

HandleLayer::HandleLayer(vtkRenderer& overlay) : overlay_(overlay) {
  const vtkNew<vtkSphereSource> ball;
  ball->SetRadius(kBall);
  parts_[0] = partActor(*ball, palette::kToolShaft);
  for (int i = 0; i < 3; ++i) {
    const vtkNew<vtkArrowSource> arrow;
    arrow->SetShaftRadius(0.018);
    arrow->SetTipRadius(0.06);
    arrow->SetTipLength(0.2);
    auto shift = partActor(*arrow, kAxisColors[i]);
    if (i == 1) shift->RotateZ(90);
    if (i == 2) shift->RotateY(-90);
    const vtkNew<vtkRegularPolygonSource> ring;
    ring->SetNumberOfSides(72);
    ring->SetRadius(1);
    ring->SetNormal(Vec3::Unit(i).eval().data());
    ring->GeneratePolygonOff();
    auto turn = partActor(*ring, kAxisColors[i]);
    turn->GetProperty()->LightingOff();
    parts_[static_cast<std::size_t>(1 + i)] = shift;
    parts_[static_cast<std::size_t>(4 + i)] = turn;
  }
  for (const auto& part : parts_) overlay_.AddActor(part);
  setPlace(std::nullopt);
}

void HandleLayer::setPlace(const std::optional<Vec3>& middle) {
  middle_ = middle;
  for (const auto& part : parts_) part->SetVisibility(middle.has_value());
}

void HandleLayer::setHighlighted(std::optional<HandlePart> part) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const bool hovered = part && static_cast<std::size_t>(*part) == i;
    const palette::Color& plain = i == 0 ? palette::kToolShaft : kAxisColors[(i - 1) % 3];
    parts_[i]->GetProperty()->SetColor(palette::forVtk(hovered ? palette::kTool : plain));
    parts_[i]->GetProperty()->SetLineWidth(hovered ? 5 : 3);
  }
}

std::optional<HandleView> HandleLayer::view() const {
  if (!middle_) return std::nullopt;
  vtkCamera& camera = *overlay_.GetActiveCamera();
  return HandleView{*middle_, -viewDirection(camera), kShare * camera.GetParallelScale()};
}

void HandleLayer::prepare() {
  const auto at = view();
  if (!at) return;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const bool shifts = i >= 1 && i <= 3;
    const double size = shifts ? kArrow * at->radius : at->radius;
    parts_[i]->SetScale(size);
    parts_[i]->SetPosition(at->middle.x(), at->middle.y(), at->middle.z());
    if (shifts)
      parts_[i]->SetVisibility(std::abs(axisOf(static_cast<HandlePart>(i)).dot(at->back)) <=
                               kHidden);
  }
}

} // namespace patina
