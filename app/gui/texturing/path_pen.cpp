#include "app/gui/texturing/path_pen.h"

#include <cmath>

#include <QKeyEvent>

#include "geometry/mesh/mesh_report.h"
#include "visualization/view/camera.h"

namespace patina {

PathPen::PathPen(ScanView& view) : QObject(&view), view_(view) {
  view_.installEventFilter(this);
}

void PathPen::setScene(const Scene& scene) {
  std::vector<Ground> grounds;
  for (const SceneObject& object : scene.objects) {
    grounds.push_back({object.mesh, object.world_from_object, nullptr});
    for (Ground& old : grounds_)
      if (old.mesh == object.mesh && old.tree) grounds.back().tree = std::move(old.tree);
  }
  grounds_ = std::move(grounds);
}

void PathPen::setOn(bool on) {
  on_ = on;
  down_ = false;
  points_.clear();
  showPath();
  view_.setCursor(on ? Qt::CrossCursor : Qt::OpenHandCursor);
  if (on) view_.setFocus();
}

// Onto the nearest object along the sight, or onto the one that the path has begun on.
void PathPen::touch(const QPoint& pixel) {
  const double high = std::max(1, view_.height());
  const Ray sight = rayThrough(*view_.picture().renderer().GetActiveCamera(),
                               (pixel.x() - 0.5 * view_.width()) / high,
                               (0.5 * view_.height() - pixel.y()) / high);
  double nearest = INFINITY;
  std::optional<Vec3> found;
  int on = object_;
  for (std::size_t i = 0; i < grounds_.size(); ++i) {
    if (object_ >= 0 && static_cast<std::size_t>(object_) != i) continue;
    Ground& ground = grounds_[i];
    if (!ground.tree) {
      const TriangleMesh clean = cleaned(*ground.mesh).mesh;
      if (clean.triangles.empty()) continue;
      ground.tree = std::make_unique<TriangleTree>(clean);
    }
    const Pose object_from_world = ground.world_from_object.inverse();
    const Vec3 from = object_from_world * sight.origin;
    const Vec3 along = object_from_world.linear() * sight.direction;
    const auto hit = ground.tree->firstHit(from, along, nearest);
    if (!hit) continue;
    nearest = hit->t;
    found = from + hit->t * along;
    on = static_cast<int>(i);
  }
  if (!found) return;
  object_ = on;
  if (points_.empty() || (points_.back() - *found).norm() > 0) points_.push_back(*found);
  showPath();
}

void PathPen::showPath() {
  DrawnPath path;
  if (object_ >= 0 && static_cast<std::size_t>(object_) < grounds_.size())
    for (const Vec3& point : points_)
      path.samples.push_back({0,
                              grounds_[static_cast<std::size_t>(object_)].world_from_object * point,
                              NAN, false, false});
  view_.picture().setPath(path);
  view_.refresh();
}

bool PathPen::eventFilter(QObject*, QEvent* event) {
  if (!on_) return false;
  if (event->type() == QEvent::KeyPress &&
      static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) {
    emit left();
    return true;
  }
  if (event->type() != QEvent::MouseButtonPress && event->type() != QEvent::MouseMove &&
      event->type() != QEvent::MouseButtonRelease && event->type() != QEvent::MouseButtonDblClick)
    return false;
  const auto& mouse = *static_cast<QMouseEvent*>(event);
  if (event->type() == QEvent::MouseMove) {
    if (down_) touch(mouse.pos());
    return down_;
  }
  if (mouse.button() != Qt::LeftButton || mouse.modifiers().testFlag(Qt::ShiftModifier))
    return false;
  if (event->type() == QEvent::MouseButtonRelease) {
    if (!std::exchange(down_, false)) return false;
    if (points_.size() > 1) emit drawn(object_, points_);
    points_.clear();
    showPath();
    return true;
  }
  down_ = true;
  object_ = -1;
  points_.clear();
  touch(mouse.pos());
  return true;
}

} // namespace patina
