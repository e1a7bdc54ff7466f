#include "app/gui/panels/strip_plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QLayout>
#include <QPainter>

#include "app/gui/window/theme.h"

namespace patina {
namespace {

constexpr double kSpan = 5;       // [s]
constexpr double kEvery = 0.004;  // [s]: 250 points a second are more than pixels
constexpr float kNothing = 1e-6F; // in the unit of the plot

QString withMinus(QString words) {
  return words.replace('-', QStringLiteral("−"));
}

} // namespace

StripPlot::StripPlot(const QString& unit, std::vector<StripCurve> curves, double least_top,
                     QWidget* parent)
    : QWidget(parent), unit_(unit), curves_(std::move(curves)), least_top_(least_top),
      top_(least_top) {
  setMinimumHeight(110);
  setAttribute(Qt::WA_OpaquePaintEvent);
}

void StripPlot::clear() {
  points_.clear();
  dirty_ = true;
}

void StripPlot::add(double t, const Values& values) {
  latest_ = t;
  dirty_ = true;
  if (points_.empty() || t >= points_.back().t + kEvery) {
    points_.push_back({t, values});
  } else {
    for (std::size_t c = 0; c < curves_.size(); ++c)
      if (curves_[c].keeps_peak)
        points_.back().value[c] = std::max(points_.back().value[c], values[c]);
  }
  while (points_.front().t < latest_ - kSpan) points_.pop_front();
}

float StripPlot::size(const Point& point) const {
  float largest = 0;
  for (std::size_t c = 0; c < curves_.size(); ++c)
    largest = std::max(largest, std::abs(point.value[c]));
  return largest;
}

void StripPlot::refresh() {
  if (!dirty_) return;
  dirty_ = false;
  // Once a line without news goes from edge to edge.
  const bool full = !points_.empty() && points_.front().t < latest_ - kSpan + 2 * kEvery;
  const bool quiet = full && std::all_of(points_.begin(), points_.end(),
                                         [this](const Point& p) { return size(p) < kNothing; });
  if (quiet && quiet_) return;
  quiet_ = quiet;
  update();
}

// Steps of 1, 2, 5, held until the plot would be less than a quarter full.
double StripPlot::top() const {
  double highest = 0;
  for (const Point& point : points_) highest = std::max(highest, static_cast<double>(size(point)));
  double step = least_top_;
  while (step < 1.05 * highest) {
    const double digit = step / std::pow(10, std::floor(std::log10(step) + 1e-9));
    step *= digit > 1.9 && digit < 2.1 ? 2.5 : 2;
  }
  return step < top_ && highest > 0.25 * top_ ? top_ : step;
}

double StripPlot::toX(const QRectF& area, double t) const {
  return area.right() + (t - latest_) / kSpan * area.width();
}

double StripPlot::toY(const QRectF& area, double value) const {
  return area.center().y() - value / top_ * area.height() / 2;
}

void StripPlot::paintAxes(QPainter& painter, const QRectF& area) const {
  const int line = QFontMetrics(font()).height();
  painter.setPen(ink("quiet"));
  painter.drawText(QRectF(0, area.top(), 26, area.height()), Qt::AlignCenter, unit_);
  for (const double value : {-top_, -0.5 * top_, 0.0, 0.5 * top_, top_}) {
    const double y = toY(area, value);
    painter.setPen(value == 0 ? ink("grip") : ink("line"));
    painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
    painter.setPen(ink("quiet"));
    painter.drawText(QRectF(14, y - 8, 38, 16), Qt::AlignRight | Qt::AlignVCenter,
                     withMinus(QString::number(value, 'g', 3)));
  }
  for (int back = 0; back <= static_cast<int>(kSpan); ++back) {
    const double x = toX(area, latest_ - back);
    painter.setPen(ink("line"));
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
    painter.setPen(ink("quiet"));
    painter.drawText(QRectF(x - 30, area.bottom() + 3, 60, line), Qt::AlignCenter,
                     back == 0 ? tr("now") : QStringLiteral("−%1 s").arg(back));
  }
}

// Room for a longer number than there is, so that the next name does not dance.
int StripPlot::legendWidth(std::size_t curve) const {
  return 29 + QFontMetrics(font()).horizontalAdvance(
                  QStringLiteral("%1 −00.00 %2").arg(curves_[curve].name, unit_));
}

QSize StripPlot::minimumSizeHint() const {
  int wide = 58 + 16 + (layout() != nullptr ? layout()->minimumSize().width() : 0);
  for (std::size_t c = 0; c < curves_.size(); ++c) wide += legendWidth(c);
  return {wide, 110};
}

void StripPlot::paintLegend(QPainter& painter, const QRectF& area) const {
  const QFontMetrics metrics(font());
  const double middle = 4 + metrics.height() / 2.0;
  double x = area.left();
  for (std::size_t c = 0; c < curves_.size(); ++c) {
    const double value = points_.empty() ? 0 : static_cast<double>(points_.back().value[c]);
    const QString words =
        withMinus(QStringLiteral("%1 %2 %3").arg(curves_[c].name).arg(value, 0, 'f', 2).arg(unit_));
    painter.setPen(QPen(ink(curves_[c].ink), 3));
    painter.drawLine(QPointF(x, middle), QPointF(x + 12, middle));
    painter.setPen(ink("text"));
    painter.drawText(QPointF(x + 17, 4 + metrics.ascent()), words);
    x += legendWidth(c);
  }
}

void StripPlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), ink("card"));
  top_ = top();
  const int line = QFontMetrics(font()).height();
  const QRectF area(58, line + 10, width() - 74, height() - 2 * line - 20);
  paintAxes(painter, area);

  painter.setClipRect(area.adjusted(0, -1, 0, 1));
  painter.setRenderHint(QPainter::Antialiasing);
  // The first curve is the one that matters: it is drawn last.
  for (std::size_t c = curves_.size(); c-- > 0;) {
    QPolygonF curve;
    curve.reserve(static_cast<int>(points_.size()));
    for (const Point& point : points_)
      curve << QPointF(toX(area, point.t), toY(area, point.value[c]));
    painter.setPen(QPen(ink(curves_[c].ink), curves_[c].width));
    painter.drawPolyline(curve);
  }
  painter.setClipping(false);
  paintLegend(painter, area);
}

} // namespace patina
