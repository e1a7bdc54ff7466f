#include "app/gui/aligning/align_view.h"

#include <cmath>

#include <QWheelEvent>

#include <vtkGenericOpenGLRenderWindow.h>

#include "app/gui/window/theme.h"

namespace patina {
namespace {
constexpr int kShake = 3;         // [px] that a click may shake
constexpr double kPickReach = 12; // of a click [px]
} // namespace

AlignView::AlignView(const char* name, ViewPreset from) : from_(from) {
  const vtkNew<vtkGenericOpenGLRenderWindow> window;
  window->SetMultiSamples(0);
  setRenderWindow(window);
  picture_.setGround(pictureGround());
  picture_.setScale(true);
  picture_.attachTo(*window);
  picture_.renderer().SetUseFXAA(true);
  setParallel(*picture_.renderer().GetActiveCamera(), true);
  setEnableHiDPI(true);
  setMinimumSize(160, 90);
  setObjectName(QString::fromUtf8(name));
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setCursor(Qt::OpenHandCursor);
}

void AlignView::setPicking(bool picks) {
  picks_ = picks;
  setCursor(picks ? Qt::CrossCursor : Qt::OpenHandCursor);
  picture_.handle().setHot(std::nullopt);
  picture_.setDirty();
}

void AlignView::refresh() {
  if (!isVisible() || width() < 50) return;
  if (fits_) {
    picture_.prepare(); // the bar has its size
    picture_.setView(from_);
    fits_ = false;
  }
  if (picture_.prepare()) renderWindow()->Render();
}

Vec3 AlignView::inPlane(const QPoint& pixel, const Vec3& through) {
  const double high = std::max(1, height());
  return pointInViewPlane(*picture_.renderer().GetActiveCamera(),
                          (pixel.x() - 0.5 * width()) / high, (0.5 * height() - pixel.y()) / high,
                          through);
}

std::optional<HandlePart> AlignView::under(const QPoint& pixel) {
  const auto view = picture_.handle().view();
  if (!view || picks_) return std::nullopt;
  return partAt(*view, inPlane(pixel, view->middle));
}

void AlignView::press(const QMouseEvent& event) {
  pressed_ = last_ = event.pos();
  held_ = event.button() == Qt::LeftButton ? under(event.pos()) : std::nullopt;
  if (!held_) return;
  held_in_ = *picture_.handle().view();
  held_at_ = inPlane(event.pos(), held_in_.middle);
  emit dragBegun();
}

void AlignView::move(const QMouseEvent& event) {
  const QPoint way = event.pos() - last_;
  last_ = event.pos();
  if (held_)
    return emit dragged(
        handleMotion(held_in_, *held_, held_at_, inPlane(event.pos(), held_in_.middle)));
  if (event.buttons() == Qt::NoButton) {
    picture_.handle().setHot(under(event.pos()));
    picture_.setDirty();
    return;
  }
  vtkCamera& camera = *picture_.renderer().GetActiveCamera();
  const double high = std::max(1, height());
  if (event.buttons().testFlag(Qt::RightButton))
    zoom(camera, std::exp(-3 * way.y() / high));
  else if (!picks_ || event.buttons().testFlag(Qt::MiddleButton))
    pan(camera, way.x() / high, -way.y() / high);
}

void AlignView::release(const QMouseEvent& event) {
  if (held_) {
    held_.reset();
    return emit dropped();
  }
  if (!picks_ || event.button() != Qt::LeftButton ||
      (event.pos() - pressed_).manhattanLength() > kShake)
    return;
  vtkCamera& camera = *picture_.renderer().GetActiveCamera();
  const double high = std::max(1, height());
  emit clicked(rayThrough(camera, (event.pos().x() - 0.5 * width()) / high,
                          (0.5 * height() - event.pos().y()) / high),
               2 * camera.GetParallelScale() / high * kPickReach);
}

bool AlignView::event(QEvent* event) {
  switch (event->type()) {
  case QEvent::MouseButtonPress:
    press(*static_cast<QMouseEvent*>(event));
    return true;
  case QEvent::MouseMove:
    move(*static_cast<QMouseEvent*>(event));
    refresh();
    return true;
  case QEvent::MouseButtonRelease:
    release(*static_cast<QMouseEvent*>(event));
    return true;
  case QEvent::MouseButtonDblClick:
    fit();
    return true;
  case QEvent::Wheel:
    zoom(*picture_.renderer().GetActiveCamera(),
         std::pow(1.12, static_cast<QWheelEvent*>(event)->angleDelta().y() / 120.));
    refresh();
    return true;
  case QEvent::Leave:
    picture_.handle().setHot(std::nullopt);
    picture_.setDirty();
    return true;
  case QEvent::PaletteChange:
    picture_.setGround(pictureGround());
    return QVTKOpenGLNativeWidget::event(event);
  case QEvent::ContextMenu:
    return true;
  case QEvent::KeyPress: // VTK's own keys are not ours
  case QEvent::KeyRelease:
    return QOpenGLWidget::event(event);
  default:
    return QVTKOpenGLNativeWidget::event(event);
  }
}

} // namespace patina
