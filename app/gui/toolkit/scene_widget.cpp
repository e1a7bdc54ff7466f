#include "app/gui/toolkit/scene_widget.h"

#include <algorithm>
#include <cmath>

#include <QApplication>
#include <QMouseEvent>
#include <QTabletEvent>
#include <QWheelEvent>
#include <vtkGenericOpenGLRenderWindow.h>

#include "app/gui/toolkit/theme.h"
#include "scene/surface_pick.h"
#include "visualization/values/camera.h"

namespace patina {
namespace {
constexpr std::chrono::milliseconds kMinFrameTime{16}; // Shortest time between frames.
// Time after an event during which the camera counts as moving.
constexpr std::chrono::milliseconds kMotionTime{100};
constexpr double kSlow = 0.025; // Slower pictures are simplified while they move [s].
constexpr int kSnapPixels = 8;  // A click this near to a vertex means the vertex.
constexpr double kTurnSeconds = 0.25;
constexpr int kTurnStep = 16;   // [ms]
constexpr double kCubeTurn = 3; // A drag on the small cube turns faster than in the picture.

// Converts a pixel to fractions of the picture's height from its centre, right and up.
Vec2 fractionOf(const QWidget& widget, const QPoint& pixel) {
  const double high = std::max(1, widget.height());
  return {(pixel.x() - 0.5 * widget.width()) / high, (0.5 * widget.height() - pixel.y()) / high};
}

} // namespace

FramePacer::FramePacer(SceneView& view, QVTKOpenGLNativeWidget& widget)
    : view_(view), widget_(widget) {
  soon_.setSingleShot(true);
  soon_.setTimerType(Qt::PreciseTimer);
  connect(&soon_, &QTimer::timeout, this, &FramePacer::refresh);
}

void FramePacer::cameraMoved() {
  moved_ = std::chrono::steady_clock::now();
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(drawn_ + kMinFrameTime - moved_);
  const int wait = std::max(0, static_cast<int>(left.count()));
  if (!soon_.isActive() || soon_.remainingTime() > wait) soon_.start(wait);
}

bool FramePacer::refresh() {
  const auto now = std::chrono::steady_clock::now();
  const bool moves = now - moved_ < kMotionTime;
  const bool plain = moves && whole_seconds_ > kSlow;
  view_.setInteracting(plain);
  const bool changed = view_.prepare();
  if (!widget_.isVisible()) return false;
  // Anti-aliasing costs 20 ms in software OpenGL; slow pictures go without while they move.
  const bool stands_still = now - drawn_ > std::chrono::milliseconds(150);
  if (!changed && (smooth_ || !stands_still)) return false;
  smooth_ = !plain && (!changed || frame_seconds_ < (smooth_ ? 0.040 : 0.020));
  view_.setSmooth(smooth_);
  widget_.renderWindow()->Render();
  drawn_ = std::chrono::steady_clock::now();
  if (moves && changed) moved_ = drawn_; // Events that were delayed by the frame arrive now.
  // The anti-aliased frame at rest is no measure of moving frames.
  if (changed) frame_seconds_ = std::chrono::duration<double>(drawn_ - now).count();
  if (changed && !plain && !view_.keepsBodies()) whole_seconds_ = frame_seconds_;
  if (plain && !soon_.isActive()) soon_.start(kMotionTime); // A complete frame follows.
  return changed;
}

CameraTurn::CameraTurn(SceneView& view, FramePacer& frames) : view_(view), frames_(frames) {
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &CameraTurn::step);
}

void CameraTurn::begin(const Vec3& direction) {
  from_ = turnOf(*view_.renderer().GetActiveCamera());
  to_ = turnFrom(direction);
  begun_ = std::chrono::steady_clock::now();
  timer_.start(kTurnStep);
}

void CameraTurn::step() {
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - begun_;
  const double part = std::min(1., since.count() / kTurnSeconds);
  const double eased = part * part * (3 - 2 * part);
  setTurn(*view_.renderer().GetActiveCamera(), part < 1 ? from_.slerp(eased, to_) : to_);
  frames_.cameraMoved();
  if (part == 1) stop();
}

Ray viewRayAt(const QWidget& widget, SceneView& view, const QPoint& pixel) {
  const Vec2 at = fractionOf(widget, pixel);
  return rayThrough(*view.renderer().GetActiveCamera(), at[0], at[1]);
}

ViewHandles::ViewHandles(QWidget& widget, SceneView& view, FramePacer& frames)
    : widget_(widget), view_(view), frames_(frames), turn_(view, frames) {}

void ViewHandles::setClip(const std::optional<ClipPlane>& plane) {
  clip_ = plane;
  if (!plane && !hot_.of_slice) hot_.clip.reset();
  view_.setClip(plane);
  frames_.cameraMoved(); // Drawn as soon as a camera motion.
}

void ViewHandles::setSliceHandle(bool on) {
  slice_handle_ = on;
  if (!on && hot_.of_slice) hot_ = {};
  view_.setSliceHandle(on);
  frames_.cameraMoved();
}

void ViewHandles::hover(const std::optional<QPoint>& pixel) {
  hot_ = {};
  if (pixel)
    hot_.cube_side = view_.cubeSideAt((pixel->x() + 0.5) / std::max(1, widget_.width()),
                                      1 - (pixel->y() + 0.5) / std::max(1, widget_.height()));
  for (const bool of_slice : {false, true}) {
    if (!pixel || hot_.cube_side || hot_.clip || (of_slice && !slice_handle_)) break;
    const auto plane = of_slice ? view_.slicePlane() : clip_;
    if (!plane) continue;
    hot_.clip = clipPartAt(*plane, view_.handleLength(of_slice), viewRayAt(widget_, view_, *pixel));
    hot_.of_slice = of_slice && hot_.clip;
  }
  view_.setHighlighted(hot_);
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
  const std::optional<ClipPlane> plane = hot_.clip ? heldPlane() : std::nullopt;
  if (plane && hot_.clip == ClipPart::tilt)
    return clipTilted(*plane, view_.handleLength(hot_.of_slice), viewRayAt(widget_, view_, to));
  if (plane)
    return clipShifted(*plane, viewRayAt(widget_, view_, from), viewRayAt(widget_, view_, to),
                       Vec3(camera.GetViewUp()));
  if (moved_) {
    const double pace = kCubeTurn / std::max(1, widget_.height());
    orbit(camera, pace * (to - from).x(), pace * (from - to).y());
    frames_.cameraMoved();
  }
  return std::nullopt;
}

SceneWidget::SceneWidget(QWidget* parent)
    : QVTKOpenGLNativeWidget(parent), frames_(view_, *this), handles_(*this, view_, frames_) {
  const vtkNew<vtkGenericOpenGLRenderWindow> window;
  window->SetMultiSamples(0); // Eight samples take three times as long in software OpenGL.
  setRenderWindow(window);
  view_.setBackgroundStyle(pictureGround());
  view_.showCube(true);
  view_.attachTo(*window);
  setEnableHiDPI(true);
  setMinimumSize(480, 320); // A docked layout may leave no pixels otherwise.
  setMouseTracking(true);   // Shows the brush before it paints.
  QCoreApplication::setAttribute(Qt::AA_CompressHighFrequencyEvents, false);
  setFocusPolicy(Qt::StrongFocus);
  showPointer();
}

void SceneWidget::showPointer() {
  setCursor(handles_.hot().cube_side ? Qt::PointingHandCursor
            : handles_.hot().clip    ? Qt::SizeAllCursor
            : draws_line_ || feels() || paints() || marks() || handling_ == InteractionMode::pick
                ? Qt::CrossCursor
                : Qt::OpenHandCursor);
}

void SceneWidget::setField(std::shared_ptr<const SurfaceField> field) {
  field_ = std::move(field);
  showPointer();
}

Vec3 SceneWidget::restingPlace() {
  vtkCamera& camera = *view_.renderer().GetActiveCamera();
  const double gap = 0.04 * view_.extent().diagonal().norm();
  const Ray ray = rayThrough(camera, 0, 0);
  if (field_)
    if (const auto hit = firstSurfaceAlong(*field_, ray.origin, ray.direction))
      return *hit - gap * ray.direction;
  return Vec3(view_.extent().center()) -
         (0.5 * view_.extent().diagonal().norm() + gap) * viewDirection(camera);
}

std::optional<Vec3> SceneWidget::surfaceAt(const QPoint& pixel) {
  if (!field_) return std::nullopt;
  const Ray sight = viewRayAt(*this, view_, pixel);
  const auto& clip = handles_.clip();
  const auto rest = clip ? behind(*clip, sight) : std::optional(sight);
  if (!rest) return std::nullopt;
  const auto hit = firstSurfaceAlong(*field_, rest->origin, rest->direction);
  // A ray that starts inside the body has no surface at its start.
  const bool within = hit && rest->origin != sight.origin &&
                      (*hit - rest->origin).norm() < 0.5 * field_->grid.voxel;
  return within ? std::nullopt : hit;
}

std::optional<Vec3> SceneWidget::lineEndAt(const QPoint& pixel) {
  const auto plane = view_.slicePlane();
  if (!plane) return surfaceAt(pixel);
  const Ray sight = viewRayAt(*this, view_, pixel);
  const double slant = sight.direction.dot(plane->normal);
  const double depth = (plane->origin - sight.origin).dot(plane->normal) / slant;
  if (!(std::abs(slant) > 1e-9 && depth > 0)) return std::nullopt;
  return sight.origin + depth * sight.direction;
}

std::optional<Vec3> SceneWidget::underPointer() {
  const bool looks = drag_ == Drag::none || drag_ == Drag::brush;
  return pointer_ && looks && !handles_.any() ? surfaceAt(*pointer_) : std::nullopt;
}

std::optional<Front> SceneWidget::frontUnderPointer() {
  const bool looks = drag_ == Drag::none || drag_ == Drag::brush;
  if (!pointer_ || !looks || handles_.any()) return std::nullopt;
  return frontAt(*pointer_);
}

std::optional<Front> SceneWidget::frontAt(const QPoint& pixel) {
  return view_.frontAlong(viewRayAt(*this, view_, pixel));
}

std::optional<Vec3> SceneWidget::vertexNear(const QPoint& pixel) {
  return view_.vertexNear(viewRayAt(*this, view_, pixel),
                          viewRayAt(*this, view_, pixel + QPoint(kSnapPixels, 0)));
}

void SceneWidget::brush(const QPoint& pixel, bool down, double pressure, const QInputEvent& event) {
  emit pointed({surfaceAt(pixel), down, pressure, 1e-3 * static_cast<double>(event.timestamp())});
}

bool SceneWidget::pick(const QMouseEvent& event) {
  const bool asked = handling_ == InteractionMode::pick ||
                     (event.modifiers().testFlag(Qt::AltModifier) &&
                      (handling_ == InteractionMode::paint || handling_ == InteractionMode::feel));
  if (!asked || event.button() != Qt::LeftButton || event.modifiers().testFlag(Qt::ShiftModifier))
    return false;
  if (const auto hit = surfaceAt(event.pos())) emit pickRequested(*hit);
  drag_ = Drag::none;
  return true;
}

bool SceneWidget::pen(QTabletEvent& event) {
  if (!paints()) return false; // Then it acts as a mouse.
  pointer_ = event.pos();
  const bool down = event.type() != QEvent::TabletRelease &&
                    (event.type() == QEvent::TabletPress || drag_ == Drag::brush);
  if (down || drag_ == Drag::brush) brush(event.pos(), down, event.pressure(), event);
  drag_ = down ? Drag::brush : Drag::none;
  event.accept();
  return true;
}

void SceneWidget::release(const QMouseEvent& event) {
  if (drag_ == Drag::orbit && (marks() || isNavigating()) && event.button() == Qt::LeftButton &&
      last_ == pressed_at_)
    emit clicked(last_);
  if (drag_ == Drag::brush) brush(last_, false, 1, event);
  if (drag_ == Drag::handle) handles_.release();
  if (drag_ == Drag::line && line_from_ != line_to_) emit lineDrawn(line_from_, line_to_, true);
  drag_ = Drag::none;
}

void SceneWidget::press(QMouseEvent& event) {
  last_ = pressed_at_ = event.pos();
  pointer_ = last_;
  if (event.button() == Qt::LeftButton && handles_.hold(last_)) {
    drag_ = Drag::handle;
    return showPointer();
  }
  if (event.button() == Qt::LeftButton && draws_line_ &&
      !event.modifiers().testFlag(Qt::ShiftModifier)) {
    const auto from = lineEndAt(last_);
    drag_ = from ? Drag::line : Drag::none;
    if (from) line_from_ = line_to_ = *from;
    return;
  }
  if (pick(event)) return;
  const bool shift = event.modifiers().testFlag(Qt::ShiftModifier);
  switch (event.button()) {
  case Qt::LeftButton:
    drag_ = paints() && !shift                                ? Drag::brush
            : feels() && !shift                               ? Drag::tip
            : shift && handling_ == InteractionMode::navigate ? Drag::pan
                                                              : Drag::orbit;
    break;
  case Qt::MiddleButton:
    drag_ = Drag::pan;
    break;
  case Qt::RightButton:
    drag_ = Drag::zoom;
    break;
  default:
    drag_ = Drag::none;
  }
  if (drag_ == Drag::tip || drag_ == Drag::brush) drag(event);
}

void SceneWidget::drag(QMouseEvent& event) {
  // A hand that shakes clicks all the same.
  if (marks() && drag_ == Drag::orbit && last_ == pressed_at_ &&
      (event.pos() - pressed_at_).manhattanLength() < QApplication::startDragDistance())
    return;
  vtkCamera& camera = *view_.renderer().GetActiveCamera();
  const Vec2 now = fractionOf(*this, event.pos());
  const QPoint from = last_;
  const Vec2 moved = now - fractionOf(*this, from);
  last_ = event.pos();
  pointer_ = last_;
  switch (drag_) {
  case Drag::brush:
    brush(last_, true, 1, event);
    break;
  case Drag::tip:
    target_ = pointInViewPlane(camera, now[0], now[1], target_);
    emit tipMoved(target_);
    break;
  case Drag::orbit:
    orbit(camera, moved[0], moved[1]);
    return frames_.cameraMoved();
  case Drag::pan:
    pan(camera, moved[0], moved[1]);
    return frames_.cameraMoved();
  case Drag::zoom:
    zoom(camera, std::exp(3 * moved[1]));
    return frames_.cameraMoved();
  case Drag::handle:
    if (const auto plane = handles_.drag(from, last_))
      handles_.hot().of_slice ? emit sliceMoved(*plane) : emit clipMoved(*plane);
    break;
  case Drag::line:
    if (const auto to = lineEndAt(last_)) {
      line_to_ = *to;
      emit lineDrawn(line_from_, line_to_, false);
    }
    break;
  case Drag::none:
    handles_.hover(pointer_);
    showPointer();
    break;
  }
}

void SceneWidget::wheel(QWheelEvent& event) {
  vtkCamera& camera = *view_.renderer().GetActiveCamera();
  const double notches = event.angleDelta().y() / 120.0;
  if (feels() && !event.modifiers().testFlag(Qt::ControlModifier)) {
    const double step = 0.004 * view_.extent().diagonal().norm();
    target_ += notches * step * viewDirection(camera);
    emit tipMoved(target_);
  } else if (paints() && handling_ == InteractionMode::press &&
             !event.modifiers().testFlag(Qt::ControlModifier)) {
    emit forceTurned(notches);
  } else {
    zoom(camera, std::pow(1.12, notches));
    frames_.cameraMoved();
  }
}

bool SceneWidget::event(QEvent* event) {
  switch (event->type()) {
  case QEvent::MouseButtonPress:
    press(*static_cast<QMouseEvent*>(event));
    return true;
  case QEvent::MouseMove:
    drag(*static_cast<QMouseEvent*>(event));
    return true;
  case QEvent::MouseButtonDblClick: {
    auto& click = *static_cast<QMouseEvent*>(event);
    if (!feels() || click.button() != Qt::LeftButton) return press(click), true;
    if (const auto hit = surfaceAt(click.pos())) emit placeRequested(*hit);
    drag_ = Drag::none;
    return true;
  }
  case QEvent::MouseButtonRelease:
    release(*static_cast<QMouseEvent*>(event));
    return true;
  case QEvent::TabletPress:
  case QEvent::TabletMove:
  case QEvent::TabletRelease:
    return pen(*static_cast<QTabletEvent*>(event));
  case QEvent::Leave:
    pointer_.reset();
    if (drag_ == Drag::none) handles_.hover(pointer_);
    return true;
  case QEvent::Wheel:
    wheel(*static_cast<QWheelEvent*>(event));
    return true;
  case QEvent::PaletteChange:
    view_.setBackgroundStyle(pictureGround());
    return QVTKOpenGLNativeWidget::event(event);
  case QEvent::ContextMenu:
    return true;
  // Disables VTK's own keys (e quits, w shows wireframes); the menus get them.
  case QEvent::KeyPress:
    if (static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape && drag_ == Drag::brush) {
      drag_ = Drag::none; // The stroke is cancelled.
      emit escaped();
      return true;
    }
    return QOpenGLWidget::event(event);
  case QEvent::KeyRelease:
    return QOpenGLWidget::event(event);
  default:
    return QVTKOpenGLNativeWidget::event(event);
  }
}

} // namespace patina
