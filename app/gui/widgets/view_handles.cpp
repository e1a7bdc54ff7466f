#include "app/gui/widgets/view_handles.h"

#include <QApplication>

#include "visualization/view/camera.h"

namespace patina {
namespace {
constexpr double kCubeTurn = 3; // a drag on the small cube turns more than one in the picture
} // namespace

Ray sightAt(const QWidget& widget, SceneView& view, const QPoint& pixel) {
  const double high = std::max(1, widget.height());
  return rayThrough(*view.renderer().GetActiveCamera(), (pixel.x() - 0.5 * widget.width()) / high,
                    (0.5 * widget.height() - pixel.y()) / high);
}

ViewHandles::ViewHandles(QWidget& widget, SceneView& view, FramePacer& frames)
    : widget_(widget), view_(view), frames_(frames), turn_(view, frames) {}

void ViewHandles::setClip(const std::optional<ClipPlane>& plane) {
  clip_ = plane;
  if (!plane) hot_.clip.reset();
  view_.setClip(plane);
  frames_.cameraMoved(); // is seen as soon as a camera that moves
}

void ViewHandles::hover(const std::optional<QPoint>& pixel) {
  hot_ = {};
  if (pixel)
    hot_.cube_side = view_.cubeSideAt((pixel->x() + 0.5) / std::max(1, widget_.width()),
                                      1 - (pixel->y() + 0.5) / std::max(1, widget_.height()));
  if (pixel && clip_ && !hot_.cube_side)
    hot_.clip = clipPartAt(*clip_, view_.clipLength(), sightAt(widget_, view_, *pixel));
  view_.setHot(hot_);
}

bool ViewHandles::hold(const QPoint& pixel) {
  turn_.stop();
  hover(pixel);
  held_from_ = pixel;
  moved_ = false;
  return any();
}

std::optional<ClipPlane> ViewHandles::drag(const QPoint& from, const QPoint& to) {
  vtkCamera& camera = *view_.renderer().GetActiveCamera();
  moved_ = moved_ || (to - held_from_).manhattanLength() >= QApplication::startDragDistance();
  if (hot_.clip == ClipPart::tilt)
    return clipTilted(*clip_, view_.clipLength(), sightAt(widget_, view_, to));
  if (hot_.clip)
    return clipShifted(*clip_, sightAt(widget_, view_, from), sightAt(widget_, view_, to),
                       Vec3(camera.GetViewUp()));
  if (moved_) {
    const double pace = kCubeTurn / std::max(1, widget_.height());
    orbit(camera, pace * (to - from).x(), pace * (from - to).y());
    frames_.cameraMoved();
  }
  return std::nullopt;
}

void ViewHandles::release() {
  if (hot_.cube_side && !moved_) turn_.begin(*hot_.cube_side);
}

} // namespace patina
