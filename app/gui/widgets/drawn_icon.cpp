#include "app/gui/widgets/drawn_icon.h"

#include <algorithm>
#include <utility>

#include <QIconEngine>
#include <QPainterPath>
#include <QPixmap>

#include "app/gui/window/theme.h"

namespace patina {
namespace {

void drawTool(QPainter& p) {
  p.setPen(QPen(ink("warm"), 2.4, Qt::SolidLine, Qt::RoundCap));
  p.drawLine(QPointF(4, 16), QPointF(9, 11));
  p.setPen(QPen(ink("text"), 2.4, Qt::SolidLine, Qt::RoundCap));
  p.drawLine(QPointF(10, 10), QPointF(16, 4));
}

void drawSurface(QPainter& p) {
  QPainterPath ground(QPointF(2, 13));
  ground.cubicTo(6, 4, 9, 8, 11, 11);
  ground.cubicTo(13, 14, 16, 12, 18, 8);
  p.setPen(QPen(ink("accent"), 1.8, Qt::SolidLine, Qt::RoundCap));
  p.drawPath(ground);
  p.setPen(QPen(ink("text"), 1.2));
  for (int i = 0; i < 4; ++i) p.drawLine(QPointF(4 + 4 * i, 17), QPointF(6 + 4 * i, 15));
}

void drawObject(QPainter& p) {
  p.drawPolygon(QPolygonF() << QPointF(10, 2) << QPointF(17, 6) << QPointF(17, 14)
                            << QPointF(10, 18) << QPointF(3, 14) << QPointF(3, 6));
  p.drawPolyline(QPolygonF() << QPointF(3, 6) << QPointF(10, 10) << QPointF(17, 6));
  p.drawLine(QPointF(10, 10), QPointF(10, 18));
}

void drawDevice(QPainter& p) {
  p.drawRoundedRect(QRectF(5, 3, 10, 14), 5, 5);
  p.drawLine(QPointF(10, 3), QPointF(10, 9));
  p.setPen(QPen(ink("warm"), 1.8, Qt::SolidLine, Qt::RoundCap));
  p.drawLine(QPointF(10, 6), QPointF(10, 7));
}

void drawEye(QPainter& p) {
  QPainterPath lids(QPointF(2, 10));
  lids.cubicTo(6, 3.5, 14, 3.5, 18, 10);
  lids.cubicTo(14, 16.5, 6, 16.5, 2, 10);
  p.drawPath(lids);
  p.setBrush(ink("accent"));
  p.drawEllipse(QPointF(10, 10), 2.6, 2.6);
}

void drawScan(QPainter& p) {
  p.drawRoundedRect(QRectF(2, 5, 12, 10), 2, 2);
  p.drawPolyline(QPolygonF() << QPointF(14, 9) << QPointF(18, 6) << QPointF(18, 14)
                             << QPointF(14, 11));
  p.setPen(QPen(ink("accent"), 1.6));
  p.drawRect(QRectF(5.5, 7.5, 5, 5));
}

void drawWave(QPainter& p) {
  p.drawLine(QPointF(2, 16), QPointF(18, 16));
  QPainterPath wave(QPointF(2, 9));
  wave.cubicTo(5, 1, 7, 1, 10, 8);
  wave.cubicTo(13, 15, 15, 12, 18, 6);
  p.setPen(QPen(ink("accent"), 1.6));
  p.drawPath(wave);
}

// A curve that comes down onto a surface.
void drawAlign(QPainter& p) {
  QPainterPath ground(QPointF(2, 17));
  ground.cubicTo(6, 10, 13, 10, 18, 17);
  p.drawPath(ground);
  QPainterPath path(QPointF(3, 8));
  path.cubicTo(7, 1, 13, 1, 17, 8);
  p.setPen(QPen(ink("accent"), 1.6));
  p.drawPath(path);
  p.drawPolyline(QPolygonF() << QPointF(8, 7.5) << QPointF(10, 10) << QPointF(12, 7.5));
}

void drawLibrary(QPainter& p) {
  for (int i = 0; i < 3; ++i) {
    p.drawRoundedRect(QRectF(2, 2.5 + 5.5 * i, 16, 4), 1, 1);
    p.drawLine(QPointF(5, 4.5 + 5.5 * i), QPointF(8 + 3 * i, 4.5 + 5.5 * i));
  }
}

// Drawn whenever it is shown: in the theme of that moment, and sharp at every scale.
class DrawnIcon final : public QIconEngine {
 public:
  explicit DrawnIcon(std::function<void(QPainter&)> draw) : draw_(std::move(draw)) {}
  QIconEngine* clone() const override { return new DrawnIcon(draw_); }
  void paint(QPainter* painter, const QRect& place, QIcon::Mode mode, QIcon::State) override {
    const double scale = std::min(place.width(), place.height()) / 20.0;
    painter->save();
    painter->setRenderHint(QPainter::Antialiasing);
    painter->translate(QRectF(place).center() - scale * QPointF(10, 10));
    painter->scale(scale, scale);
    if (mode == QIcon::Disabled) painter->setOpacity(0.4);
    painter->setPen(QPen(ink("text"), 1.4, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    draw_(*painter);
    painter->restore();
  }
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
    QPixmap made(size);
    made.fill(Qt::transparent);
    QPainter painter(&made);
    paint(&painter, QRect(QPoint(), size), mode, state);
    return made;
  }

 private:
  std::function<void(QPainter&)> draw_;
};

} // namespace

QIcon drawnIcon(const std::function<void(QPainter&)>& draw) {
  return QIcon(new DrawnIcon(draw));
}

QIcon iconOf(Tab tab) {
  constexpr void (*kDraw[])(QPainter&) = {drawTool, drawSurface, drawObject, drawDevice, drawEye,
                                          drawScan, drawWave,    drawAlign,  drawLibrary};
  return drawnIcon(kDraw[static_cast<std::size_t>(tab)]);
}

} // namespace patina
