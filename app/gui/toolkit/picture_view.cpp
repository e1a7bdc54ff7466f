#include "app/gui/toolkit/picture_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include "app/gui/toolkit/theme.h"

namespace patina {
namespace {

const QColor kSeam(0, 0, 0, 170);
constexpr double kWheelZoom = 1.25, kMaxZoom = 40;
constexpr double kCross = 4, kRing = 5; // Radii [px].

} // namespace

PictureView::PictureView(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

double PictureView::scale() const {
  return zoom_ * std::min(static_cast<double>(width()) / content_.picture.width(),
                          static_cast<double>(height()) / content_.picture.height());
}

QPointF PictureView::placeOf(const QPointF& pixel) const {
  const QSizeF size = content_.picture.size();
  return QPointF(0.5 * width(), 0.5 * height()) + shift_ +
         scale() * (pixel + QPointF(0.5 - 0.5 * size.width(), 0.5 - 0.5 * size.height()));
}

void PictureView::zoom(const QPointF& place, double notches) {
  const double before = zoom_;
  zoom_ = std::clamp(zoom_ * std::pow(kWheelZoom, notches), 1., kMaxZoom);
  const QPointF at = place - QPointF(0.5 * width(), 0.5 * height());
  shift_ = zoom_ == 1 ? QPointF() : at + (shift_ - at) * (zoom_ / before);
}

bool PictureView::event(QEvent* event) {
  const auto place = [event] { return static_cast<QMouseEvent*>(event)->localPos(); };
  switch (event->type()) {
  case QEvent::Wheel: {
    const auto& wheel = *static_cast<QWheelEvent*>(event);
    zoom(wheel.position(), wheel.angleDelta().y() / 120.);
    break;
  }
  case QEvent::MouseButtonPress:
    last_ = place();
    break;
  case QEvent::MouseMove:
    if (zoom_ > 1) shift_ += place() - last_;
    last_ = place();
    break;
  case QEvent::MouseButtonDblClick:
    zoom_ = 1;
    shift_ = {};
    break;
  default:
    return QWidget::event(event);
  }
  event->accept();
  update();
  return true;
}

void PictureView::paintMark(QPainter& painter, const PictureMark& mark) const {
  QPolygonF placed;
  for (const QPointF& point : mark.points) placed << placeOf(point);
  if (placed.isEmpty()) return;
  for (const auto& [ink, wide] : {std::pair(kSeam, mark.width + 2), {mark.color, mark.width}}) {
    painter.setPen(QPen(ink, wide, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    if (mark.shape == PictureMark::Shape::line) painter.drawPolyline(placed);
    if (mark.shape == PictureMark::Shape::ring) painter.drawEllipse(placed[0], kRing, kRing);
    if (mark.shape == PictureMark::Shape::crosses)
      for (const QPointF& at : placed) {
        painter.drawLine(at - QPointF(kCross, 0), at + QPointF(kCross, 0));
        painter.drawLine(at - QPointF(0, kCross), at + QPointF(0, kCross));
      }
  }
  if (mark.tag.isEmpty()) return;
  const QRectF box = placed.boundingRect();
  const QFontMetricsF letters = painter.fontMetrics();
  const QPointF at =
      placed.isClosed()
          ? QPointF(box.left() - 10 - letters.horizontalAdvance(mark.tag), box.center().y() + 4)
          : placed.back() + QPointF(3, -3);
  painter.fillRect(letters.boundingRect(mark.tag).adjusted(-3, -1, 3, 1).translated(at), kSeam);
  painter.setPen(mark.color);
  painter.drawText(at, mark.tag);
}

void PictureView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), themeColor("soft"));
  const QSize size = content_.picture.size();
  if (size.isEmpty()) {
    painter.setPen(themeColor("quiet"));
    painter.drawText(rect().adjusted(12, 12, -12, -12), Qt::AlignCenter | Qt::TextWordWrap,
                     content_.words);
    return;
  }
  QFont bold = font();
  bold.setBold(true);
  painter.setFont(bold);
  painter.setRenderHint(QPainter::SmoothPixmapTransform, content_.smooth);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.drawImage(
      QRectF(placeOf({-0.5, -0.5}), placeOf({size.width() - 0.5, size.height() - 0.5})),
      content_.picture);
  for (const PictureMark& mark : content_.marks) paintMark(painter, mark);
}

} // namespace patina
