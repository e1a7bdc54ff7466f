#include "app/gui/painting/brush_curve.h"

#include <cmath>

#include <QPainter>

#include "app/gui/window/theme.h"
#include "authoring/brush/painter.h"

namespace patina {

BrushCurve::BrushCurve(QWidget* parent) : QWidget(parent) {
  setFixedHeight(44);
  setToolTip(tr("How strongly the brush paints from rim to rim"));
}

void BrushCurve::setBrush(const Brush& brush) {
  brush_ = brush;
  update();
}

void BrushCurve::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF frame = QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5);
  painter.setPen(ink("line"));
  painter.setBrush(ink("soft"));
  painter.drawRoundedRect(frame, 3, 3);
  const double high = frame.height() - 8, base = frame.bottom() - 3;
  QPolygonF curve;
  const int steps = std::max(2, static_cast<int>(frame.width()) - 8);
  for (int i = 0; i <= steps; ++i) {
    const double d = std::abs(2.0 * i / steps - 1);
    curve << QPointF(frame.left() + 4 + i, base - high * (d < 1 ? brushWeight(brush_, d, 1) : 0));
  }
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(0x2b, 0x6c, 0xb0, 60));
  painter.drawPolygon(curve);
  painter.setPen(QPen(ink("accent"), 1.4));
  painter.drawPolyline(curve);
}

} // namespace patina
