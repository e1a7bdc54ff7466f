#include "app/gui/aligning/alignment.h"

#include <algorithm>
#include <cmath>

#include "acquisition/registration/first_guess.h"
#include "geometry/mesh/mesh_report.h"

namespace patina {
namespace {

constexpr std::size_t kMaxLivePoints = 400;    // Points that are evaluated during a drag.
constexpr std::size_t kMaxProfilePoints = 120; // Points that are evaluated for a cost profile.
constexpr int kAcross = 21;                    // Steps across a cost profile.

std::vector<Vec3> someOf(const std::vector<Vec3>& points, std::size_t count) {
  if (points.size() <= count) return points;
  std::vector<Vec3> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(points[i * points.size() / count]);
  return some;
}

Vec3 middleOf(const std::vector<Vec3>& points) {
  return scaleOf(points, Pose::Identity()).centre;
}

} // namespace

Residuals residualsOf(const SurfaceTarget& target, const std::vector<Vec3>& points,
                      const Pose& mesh_from_path) {
  Residuals found;
  double squares = 0;
  std::int32_t face = kNone;
  for (const Vec3& point : points) {
    const ClosestPoint near = target.tree().closestPoint(mesh_from_path * point, face);
    face = near.surface.face;
    found.distances.push_back(near.distance);
    found.feet.push_back(near.point);
    found.mean += near.distance;
    squares += near.distance * near.distance;
    found.worst = std::max(found.worst, near.distance);
  }
  const double count = static_cast<double>(std::max<std::size_t>(1, points.size()));
  found.mean /= count;
  found.rms = std::sqrt(squares / count);
  return found;
}

CostProfile costProfileAround(const SurfaceTarget& target, const std::vector<Vec3>& points,
                              const Pose& mesh_from_path, Progress& progress) {
  const std::vector<Vec3> some = someOf(points, kMaxProfilePoints);
  CostProfile profile;
  profile.shift = 0.15 * target.extent();
  profile.turn = 0.35;
  profile.side = kAcross;
  const Vec3 middle = mesh_from_path * middleOf(some);
  const auto part = [](int step) { return 2. * step / (kAcross - 1) - 1; };
  for (int axis = 0; axis < 3; ++axis)
    for (int step = 0; step < kAcross; ++step) {
      progress.throwIfCancelled();
      Pose shift = Pose::Identity(), turn = Pose::Identity();
      shift.translation() = part(step) * profile.shift * Vec3::Unit(axis);
      turn.linear() =
          Eigen::AngleAxisd(part(step) * profile.turn, Vec3::Unit(axis)).toRotationMatrix();
      turn.translation() = middle - turn.linear() * middle;
      const auto i = static_cast<std::size_t>(axis);
      profile.along[i].push_back(residualsOf(target, some, shift * mesh_from_path).rms);
      profile.along[i + 3].push_back(residualsOf(target, some, turn * mesh_from_path).rms);
    }
  for (int row = 0; row < kAcross; ++row)
    for (int column = 0; column < kAcross; ++column) {
      progress.throwIfCancelled();
      Pose shift = Pose::Identity();
      shift.translation() = profile.shift * (part(column) * Vec3::Unit(profile.first) +
                                             part(row) * Vec3::Unit(profile.second));
      profile.map.push_back(residualsOf(target, some, shift * mesh_from_path).rms);
    }
  return profile;
}

Registration registeredAt(const SurfaceTarget& target, const std::vector<PathSample>& path,
                          const Pose& mesh_from_path) {
  Registration found;
  found.mesh_from_path = mesh_from_path;
  for (const PathSample& sample : path)
    found.residuals.push_back(target.residual(mesh_from_path * sample.position));
  found.inliers.assign(path.size(), true);
  return found;
}

void Alignment::setMesh(std::shared_ptr<const TriangleMesh> mesh) {
  target_.reset();
  mesh_ = std::move(mesh);
  begin();
}

void Alignment::changeMesh(std::shared_ptr<const TriangleMesh> mesh) {
  if (steps_.empty()) return setMesh(std::move(mesh));
  target_.reset();
  mesh_ = std::move(mesh);
  for (Step& step : steps_) step.fit.reset();
  makeTarget();
}

void Alignment::setPath(std::vector<PathSample> path, double tip_radius) {
  whole_ = std::move(path);
  if (tip_radius != tip_radius_) target_.reset();
  tip_radius_ = tip_radius;
  begin();
}

void Alignment::begin() {
  steps_.clear();
  at_ = 0;
  moved_ = false;
  path_ = whole_;
  makeTarget();
  // The registration reports these warnings, so they are dropped here.
  std::vector<std::string> default_sigmas;
  if (target_) path_ = touchingOn(target_->mesh(), std::move(path_), default_sigmas);
  std::vector<Vec3> all;
  for (const PathSample& sample : path_) all.push_back(sample.position);
  points_ = someOf(all, kMaxLivePoints);
  if (!isReady()) return;
  pose_ = alignCenters(target_->mesh(), points_);
  steps_ = {{pose_, {}}};
}

void Alignment::makeTarget() {
  if (path_.empty() || mesh_ == nullptr || target_ != nullptr) return;
  TriangleMesh clean = cleaned(*mesh_).mesh;
  if (!clean.triangles.empty())
    target_ = std::make_shared<const SurfaceTarget>(std::move(clean), tip_radius_, true);
}

Vec3 Alignment::centroid() const {
  return pose_ * middleOf(points_);
}

const std::optional<Registration>& Alignment::found() const {
  static const std::optional<Registration> kNoFit;
  return steps_.empty() || moved_ ? kNoFit : steps_[at_].fit;
}

void Alignment::commit(std::optional<Registration> fit) {
  if (steps_.empty()) return;
  if (!pose_.isApprox(steps_[at_].pose, 1e-12)) {
    steps_.resize(++at_);
    steps_.push_back({pose_, {}});
  }
  moved_ = false;
  if (fit) steps_[at_].fit = std::move(fit);
}

bool Alignment::undo() {
  commit();
  if (at_ == 0) return false;
  pose_ = steps_[--at_].pose;
  return true;
}

bool Alignment::redo() {
  if (undone() == 0) return false;
  pose_ = steps_[++at_].pose;
  moved_ = false;
  return true;
}

std::vector<Pose> Alignment::steps() const {
  std::vector<Pose> poses;
  for (const Step& step : steps_) poses.push_back(step.pose);
  return poses;
}

} // namespace patina
