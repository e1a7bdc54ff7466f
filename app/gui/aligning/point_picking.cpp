#include "app/gui/aligning/point_picking.h"

#include <algorithm>
#include <cmath>

#include <QObject>

#include "acquisition/registration/rigid_fit.h"

namespace patina {
namespace {

constexpr double kSpread = 0.01; // of the mesh, that places are apart at least

} // namespace

void PointPicking::set(bool on) {
  on_ = on;
  on_path_.clear();
  on_mesh_.clear();
}

void PointPicking::pick(const Ray& sight, double reach) {
  const auto isNew = [&](const std::vector<Vec3>& list, const Vec3& point) {
    return std::all_of(list.begin(), list.end(), [&](const Vec3& other) {
      return (other - point).norm() > kSpread * alignment_.target()->extent();
    });
  };
  if (on_path_.size() == on_mesh_.size()) {
    double nearest = reach;
    std::optional<Vec3> found;
    for (const Vec3& point : alignment_.points()) {
      const Vec3 away = alignment_.pose() * point - sight.origin;
      const double off = (away - away.dot(sight.direction) * sight.direction).norm();
      if (off >= nearest) continue;
      nearest = off;
      found = point;
    }
    if (found && isNew(on_path_, *found)) on_path_.push_back(*found);
  } else if (const auto hit =
                 alignment_.target()->tree().firstHit(sight.origin, sight.direction, INFINITY)) {
    const Vec3 point = sight.origin + hit->t * sight.direction;
    if (isNew(on_mesh_, point)) on_mesh_.push_back(point);
  }
}

QString PointPicking::words() const {
  if (!on_) return {};
  return (on_path_.size() == on_mesh_.size()
              ? QObject::tr("%1 of 3: click a place on the path (Esc ends it)")
              : QObject::tr("%1 of 3: click the same place on the mesh"))
      .arg(on_mesh_.size() + 1);
}

std::vector<DrawnMark> PointPicking::marks() const {
  std::vector<DrawnMark> marks;
  for (const Vec3& point : on_path_) marks.push_back({0, alignment_.pose() * point});
  for (const Vec3& point : on_mesh_) marks.push_back({0, point});
  return marks;
}

std::optional<Pose> PointPicking::pose() const {
  if (on_mesh_.size() < 3) return std::nullopt;
  return fitRigid(on_path_, on_mesh_);
}

} // namespace patina
