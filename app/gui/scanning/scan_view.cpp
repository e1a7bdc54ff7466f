#include "app/gui/scanning/scan_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QApplication>
#include <QStatusTipEvent>
#include <QWheelEvent>
#include <vtkGenericOpenGLRenderWindow.h>

#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/words.h"

namespace patina {
namespace {
constexpr int kShake = 3; // Smallest movement that makes a drag [px].
} // namespace

ScanView::ScanView(QWidget* parent) : QVTKOpenGLNativeWidget(parent) {
  const vtkNew<vtkGenericOpenGLRenderWindow> window;
  window->SetMultiSamples(0);
  setRenderWindow(window);
  picture_.setBackgroundStyle(pictureGround());
  picture_.setScale(true);
  picture_.attachTo(*window);
  picture_.renderer().SetUseFXAA(true);
  setEnableHiDPI(true);
  setMinimumSize(220, 200);
  setObjectName(QStringLiteral("scan_view"));
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setCursor(Qt::OpenHandCursor);
}

ScanView::~ScanView() = default;

void ScanView::refresh() {
  if (!isVisible() || width() < 50) return;
  if (look_) {
    picture_.prepare(); // Gives the colour bar its size.
    std::exchange(look_, nullptr)();
  }
  if (picture_.prepare()) renderWindow()->Render();
}

QPointF ScanView::inHeights(const QPoint& pixel) const {
  return QPointF(pixel.x() - 0.5 * width(), 0.5 * height() - pixel.y()) / std::max(1, height());
}

bool ScanView::isClick(const QMouseEvent& event) const {
  return (event.pos() - pressed_).manhattanLength() <= kShake;
}

void ScanView::move(const QMouseEvent& event, double dx, double dy) {
  if (event.buttons() == Qt::NoButton)
    showUnderPointer(event.pos());
  else if (event.buttons().testFlag(Qt::LeftButton))
    event.modifiers().testFlag(Qt::ShiftModifier) ? pan(camera(), dx, dy) : orbit(camera(), dx, dy);
  else if (event.buttons().testFlag(Qt::MiddleButton))
    pan(camera(), dx, dy);
  else if (event.buttons().testFlag(Qt::RightButton))
    zoom(camera(), std::exp(3 * dy));
}

void ScanView::release(const QMouseEvent& event) {
  if (!isClick(event)) return;
  if (const auto sample = sampleAt(event.pos())) emit timePicked(sample->t);
}

std::optional<DrawnSample> ScanView::sampleAt(const QPoint& pixel) const {
  const double scale = devicePixelRatioF();
  return picture_.sampleAt(scale * pixel.x(), scale * (height() - 1 - pixel.y()),
                           scale * kPickReach);
}

void ScanView::showUnderPointer(const QPoint& pixel) {
  QString words;
  if (const auto sample = sampleAt(pixel)) {
    const auto fixed = [](double value) { return QString::number(shownAs(value, 3), 'f', 3); };
    const Vec3 at = 1e3 * sample->position;
    words = tr("Path at %1 s · %2, %3, %4 mm")
                .arg(fixed(sample->t), fixed(at.x()), fixed(at.y()), fixed(at.z()));
    if (std::isfinite(sample->value) && !picture_.pathTitle().empty())
      words += QStringLiteral(" · %1 %2")
                   .arg(shownText(picture_.pathTitle()), QString::number(sample->value, 'g', 4));
  }
  sendTip(words);
}

// The window shows it in its status line.
void ScanView::sendTip(const QString& words) {
  QStatusTipEvent tip(words);
  QApplication::sendEvent(this, &tip);
}

bool ScanView::event(QEvent* event) {
  const auto mouse = [event]() -> QMouseEvent& { return *static_cast<QMouseEvent*>(event); };
  switch (event->type()) {
  case QEvent::MouseButtonPress:
    pressed_ = last_ = mouse().pos();
    press(mouse());
    return true;
  case QEvent::MouseMove: {
    const QPointF way = inHeights(mouse().pos()) - inHeights(std::exchange(last_, mouse().pos()));
    move(mouse(), way.x(), way.y());
    refresh();
    return true;
  }
  case QEvent::MouseButtonRelease:
    release(mouse());
    return true;
  case QEvent::MouseButtonDblClick:
    fit();
    return true;
  case QEvent::Leave:
    leave();
    sendTip({});
    return true;
  case QEvent::Wheel:
    zoom(camera(), std::pow(1.12, static_cast<QWheelEvent*>(event)->angleDelta().y() / 120.));
    refresh();
    return true;
  case QEvent::PaletteChange:
    picture_.setBackgroundStyle(pictureGround());
    return QVTKOpenGLNativeWidget::event(event);
  case QEvent::ContextMenu:
    return true;
  case QEvent::KeyPress: // Disables VTK's own keys.
  case QEvent::KeyRelease:
    return QOpenGLWidget::event(event);
  default:
    return QVTKOpenGLNativeWidget::event(event);
  }
}

} // namespace patina
