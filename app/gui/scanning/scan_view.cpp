#include "app/gui/scanning/scan_view.h"

#include <cmath>

#include <QWheelEvent>

#include <vtkGenericOpenGLRenderWindow.h>

#include "app/gui/window/theme.h"
#include "visualization/view/camera.h"

namespace patina {
namespace {
constexpr int kShake = 3;         // [px] that a click may shake
constexpr double kPickReach = 12; // of a click [px]
} // namespace

ScanView::ScanView(QWidget* parent) : QVTKOpenGLNativeWidget(parent) {
  const vtkNew<vtkGenericOpenGLRenderWindow> window;
  window->SetMultiSamples(0);
  setRenderWindow(window);
  picture_.setGround(pictureGround());
  picture_.setScale(true);
  picture_.attachTo(*window);
  picture_.renderer().SetUseFXAA(true);
  setEnableHiDPI(true);
  setMinimumSize(220, 200);
  setObjectName(QStringLiteral("scan_view"));
  setFocusPolicy(Qt::StrongFocus);
  setCursor(Qt::OpenHandCursor);
}

ScanView::~ScanView() = default;

void ScanView::refresh() {
  if (!isVisible() || width() < 50) return;
  if (up_) {
    picture_.prepare(); // the bar has its size
    picture_.lookAtAll(*up_);
    up_.reset();
  }
  if (picture_.prepare()) renderWindow()->Render();
}

void ScanView::lookAtAll(const Vec3& up) {
  up_ = up;
}

void ScanView::move(const QMouseEvent& event) {
  const QPoint way = event.pos() - last_;
  last_ = event.pos();
  vtkCamera& camera = *picture_.renderer().GetActiveCamera();
  const double high = std::max(1, height());
  const double dx = way.x() / high, dy = -way.y() / high;
  if (event.buttons().testFlag(Qt::LeftButton))
    event.modifiers().testFlag(Qt::ShiftModifier) ? pan(camera, dx, dy) : orbit(camera, dx, dy);
  else if (event.buttons().testFlag(Qt::MiddleButton))
    pan(camera, dx, dy);
  else if (event.buttons().testFlag(Qt::RightButton))
    zoom(camera, std::exp(3 * dy));
  refresh();
}

void ScanView::pick(const QPoint& place) {
  const double scale = devicePixelRatioF();
  const auto t =
      picture_.timeAt(scale * place.x(), scale * (height() - 1 - place.y()), scale * kPickReach);
  if (t) emit timePicked(*t);
}

bool ScanView::event(QEvent* event) {
  switch (event->type()) {
  case QEvent::MouseButtonPress:
    pressed_ = last_ = static_cast<QMouseEvent*>(event)->pos();
    return true;
  case QEvent::MouseMove:
    move(*static_cast<QMouseEvent*>(event));
    return true;
  case QEvent::MouseButtonRelease: {
    const QPoint place = static_cast<QMouseEvent*>(event)->pos();
    if ((place - pressed_).manhattanLength() <= kShake) pick(place);
    return true;
  }
  case QEvent::MouseButtonDblClick:
    picture_.fit();
    refresh();
    return true;
  case QEvent::Wheel:
    zoom(*picture_.renderer().GetActiveCamera(),
         std::pow(1.12, static_cast<QWheelEvent*>(event)->angleDelta().y() / 120.));
    refresh();
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
