#include "app/gui/toolkit/drawn_icon.h"

#include <algorithm>

#include <QIconEngine>
#include <QPainter>
#include <QPainterPath>
#include <QPixmap>

#include "app/gui/toolkit/theme.h"

namespace patina {
namespace {

QColor colorIn(const QString& word) {
  if (word.startsWith('#')) return QColor(word);
  const QColor color = themeColor(word.section('/', 0, 0).toUtf8().constData());
  return word.contains('/') ? color.darker(word.section('/', 1).toInt()) : color;
}

void drawStep(QPainter& painter, const QString& step) {
  const QStringList words = step.simplified().split(' ');
  const auto is = [&](const char* what) { return words[0] == QLatin1String(what); };
  if (is("round") || is("square") || is("soft"))
    return painter.setPen(QPen(colorIn(words[1]), words[2].toDouble(), Qt::SolidLine,
                               is("square") ? Qt::SquareCap : Qt::RoundCap,
                               is("soft") ? Qt::RoundJoin : Qt::BevelJoin));
  if (is("fill")) return painter.setBrush(colorIn(words[1]));
  if (is("back")) return painter.restore();
  QVector<double> n;
  for (int i = 1; i < words.size(); ++i) n << words[i].toDouble();
  QPolygonF points;
  for (int i = 0; i + 1 < n.size(); i += 2) points << QPointF(n[i], n[i + 1]);
  if (is("line") && points.size() == 2) return painter.drawLine(points[0], points[1]);
  if (is("line")) return painter.drawPolyline(points);
  if (is("polygon")) return painter.drawPolygon(points);
  if (is("ellipse")) return painter.drawEllipse(points[0], n[2], n[3]);
  if (is("box") && n.size() > 4)
    return painter.drawRoundedRect(QRectF(n[0], n[1], n[2], n[3]), n[4], n[4]);
  if (is("box")) return painter.drawRect(QRectF(n[0], n[1], n[2], n[3]));
  if (is("turn")) {
    painter.save();
    painter.translate(10, 10);
    return painter.rotate(n[0]);
  }
  QPainterPath path(points[0]);
  for (int i = 1; i + 2 < points.size(); i += 3)
    path.cubicTo(points[i], points[i + 1], points[i + 2]);
  if (is("blob")) path.closeSubpath();
  painter.drawPath(path);
}

// Drawn each time it is shown, in the current theme and sharp at every scale.
class DrawnIcon final : public QIconEngine {
 public:
  explicit DrawnIcon(const char* steps) : steps_(steps) {}
  QIconEngine* clone() const override { return new DrawnIcon(steps_); }
  void paint(QPainter* painter, const QRect& place, QIcon::Mode mode, QIcon::State) override {
    const double scale = std::min(place.width(), place.height()) / 20.0;
    painter->save();
    painter->setRenderHint(QPainter::Antialiasing);
    painter->translate(QRectF(place).center() - scale * QPointF(10, 10));
    painter->scale(scale, scale);
    if (mode == QIcon::Disabled) painter->setOpacity(0.4);
    painter->setPen(QPen(themeColor("text"), 1.4, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    for (const QString& step : QString::fromLatin1(steps_).split(';')) drawStep(*painter, step);
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
  const char* steps_;
};

} // namespace

QIcon drawnIcon(const char* steps) {
  return QIcon(new DrawnIcon(steps));
}

} // namespace patina
