#include "app/gui/widgets/scene_widget.h"

#include <cmath>

#include <QApplication>
#include <QMouseEvent>
#include <QTabletEvent>
#include <QWheelEvent>

#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkRenderWindowInteractor.h>

#include "app/gui/window/theme.h"
#include "scene/surface_pick.h"
#include "visualization/view/camera.h"

namespace patina {
namespace {

// A pixel in fractions of the picture's height, from its centre, right and up.
Vec2 fractionOf(const QWidget& widget, const QPoint& pixel) {
  const double high = std::max(1, widget.height());
  return {(pixel.x() - 0.5 * widget.width()) / high, (0.5 * widget.height() - pixel.y()) / high};
}

} // namespace

SceneWidget::SceneWidget(QWidget* parent)
    : QVTKOpenGLNativeWidget(parent), frames_(view_, *this), handles_(*this, view_, frames_) {
  const vtkNew<vtkGenericOpenGLRenderWindow> window;
  window->SetMultiSamples(0); // three times slower with 8 samples when OpenGL is software
  setRenderWindow(window);
  view_.setGround(pictureGround());
  view_.showCube(true);
  view_.attachTo(*window);
  setEnableHiDPI(true);
  setMinimumSize(480,
                 320);    // without one, a docked layout may give it no pixel and nothing is drawn
  setMouseTracking(true); // the brush is seen before it paints
  QCoreApplication::setAttribute(Qt::AA_CompressHighFrequencyEvents, false); // each one counts
  setFocusPolicy(Qt::StrongFocus);
  setHandling(handling_);
}

void SceneWidget::setHandling(Handling handling) {
  handling_ = handling;
  showPointer();
}

void SceneWidget::showPointer() {
  setCursor(handles_.hot().cube_side                             ? Qt::PointingHandCursor
            : handles_.hot().clip                                ? Qt::SizeAllCursor
            : feels() || paints() || handling_ == Handling::pick ? Qt::CrossCursor
                                                                 : Qt::OpenHandCursor);
}

void SceneWidget::setClip(const std::optional<ClipPlane>& plane) {
  handles_.setClip(plane);
}

void SceneWidget::setField(std::shared_ptr<const SurfaceField> field) {
  field_ = std::move(field);
  setHandling(handling_);
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
  const Ray sight = sightAt(*this, view_, pixel);
  const auto& clip = handles_.clip();
  const auto rest = clip ? behind(*clip, sight) : std::optional(sight);
  if (!rest) return std::nullopt;
  const auto hit = firstSurfaceAlong(*field_, rest->origin, rest->direction);
  // A sight that begins within the body meets no surface where it begins.
  const bool within = hit && rest->origin != sight.origin &&
                      (*hit - rest->origin).norm() < 0.5 * field_->grid.voxel;
  return within ? std::nullopt : hit;
}

std::optional<Vec3> SceneWidget::underPointer() {
  const bool looks = drag_ == Drag::none || drag_ == Drag::brush;
  return pointer_ && looks && !handles_.any() ? surfaceAt(*pointer_) : std::nullopt;
}

void SceneWidget::brush(const QPoint& pixel, bool down, double pressure, const QInputEvent& event) {
  emit pointed({surfaceAt(pixel), down, pressure, 1e-3 * static_cast<double>(event.timestamp())});
}

bool SceneWidget::pick(const QMouseEvent& event) {
  const bool asked = handling_ == Handling::pick ||
                     (event.modifiers().testFlag(Qt::AltModifier) &&
                      (handling_ == Handling::paint || handling_ == Handling::feel));
  if (!asked || event.button() != Qt::LeftButton || event.modifiers().testFlag(Qt::ShiftModifier))
    return false;
  if (const auto hit = surfaceAt(event.pos())) emit pickAsked(*hit);
  drag_ = Drag::none;
  return true;
}

bool SceneWidget::pen(QTabletEvent& event) {
  if (!paints()) return false; // it is a mouse then
  pointer_ = event.pos();
  const bool down = event.type() != QEvent::TabletRelease &&
                    (event.type() == QEvent::TabletPress || drag_ == Drag::brush);
  if (down || drag_ == Drag::brush) brush(event.pos(), down, event.pressure(), event);
  drag_ = down ? Drag::brush : Drag::none;
  event.accept();
  return true;
}

void SceneWidget::release(const QMouseEvent& event) {
  if (drag_ == Drag::brush) brush(last_, false, 1, event);
  if (drag_ == Drag::handle) handles_.release();
  drag_ = Drag::none;
}

void SceneWidget::press(QMouseEvent& event) {
  last_ = event.pos();
  pointer_ = last_;
  if (event.button() == Qt::LeftButton && handles_.hold(last_)) {
    drag_ = Drag::handle;
    return showPointer();
  }
  if (pick(event)) return;
  const bool shift = event.modifiers().testFlag(Qt::ShiftModifier);
  switch (event.button()) {
  case Qt::LeftButton:
    drag_ = paints() && !shift                         ? Drag::brush
            : feels() && !shift                        ? Drag::tip
            : shift && handling_ == Handling::navigate ? Drag::pan
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
    if (const auto plane = handles_.drag(from, last_)) emit clipMoved(*plane);
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
  } else if (paints() && handling_ == Handling::press &&
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
    if (const auto hit = surfaceAt(click.pos())) emit placeAsked(*hit);
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
    view_.setGround(pictureGround());
    return QVTKOpenGLNativeWidget::event(event);
  case QEvent::ContextMenu:
    return true;
  // VTK's own key bindings (e quits, w wireframes) are not ours: keys go to the window's menus.
  case QEvent::KeyPress:
    if (static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape && drag_ == Drag::brush) {
      drag_ = Drag::none; // the stroke is taken back
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
