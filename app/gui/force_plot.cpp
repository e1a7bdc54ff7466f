#include "app/gui/force_plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QPainter>
#include <QPainterPath>

#include "app/gui/window_style.h"

namespace patina {
namespace {

constexpr double kSpan = 5;       // [s]
constexpr int kEvery = 4;         // of 1000 a second: 250 points a second are more than pixels
constexpr float kNothing = 1e-6F; // [N]

struct Curve {
  const char* name;
  QColor color;
  qreal width;
};

std::array<Curve, 4> curves() {
  return {{{"|F|", toQColor(palette::kForce), 2.0},
           {"x", QColor(0xb5, 0x4a, 0x40), 1.1},
           {"y", QColor(0x3f, 0x8c, 0x45), 1.1},
           {"z", QColor(0x35, 0x62, 0xb5), 1.1}}};
}

} // namespace

ForcePlot::ForcePlot(QWidget* parent) : QWidget(parent) {
  setMinimumHeight(110);
  setAttribute(Qt::WA_OpaquePaintEvent);
  setToolTip(tr("Force on the hand over the last five seconds"));
}

void ForcePlot::clear() {
  points_.clear();
  dirty_ = true;
}

void ForcePlot::add(const std::vector<ToolSample>& samples) {
  for (const ToolSample& sample : samples) {
    latest_ = sample.t;
    // A peak must not fall between two points.
    const auto force = static_cast<float>(sample.force.norm());
    if (points_.empty() || sample.t >= points_.back().t + 0.001 * kEvery)
      points_.push_back(
          {sample.t,
           {force, static_cast<float>(sample.force[0]), static_cast<float>(sample.force[1]),
            static_cast<float>(sample.force[2])}});
    else
      points_.back().f[0] = std::max(points_.back().f[0], force);
  }
  while (!points_.empty() && points_.front().t < latest_ - kSpan) points_.pop_front();
  if (!samples.empty()) dirty_ = true;
}

void ForcePlot::refresh() {
  if (!dirty_) return;
  dirty_ = false;
  const bool quiet =
      std::all_of(points_.begin(), points_.end(), [](const Point& p) { return p.f[0] < kNothing; });
  if (quiet && quiet_) return;
  quiet_ = quiet;
  update();
}

// Steps of 1, 2, 5, held until the plot would be less than a quarter full.
double ForcePlot::top() const {
  float highest = 0;
  for (const Point& point : points_) highest = std::max(highest, point.f[0]);
  double step = 0.5;
  while (step < 1.05 * highest) {
    const double digit = step / std::pow(10, std::floor(std::log10(step) + 1e-9));
    step *= digit > 1.9 && digit < 2.1 ? 2.5 : 2;
  }
  return step < top_ && highest > 0.25 * top_ ? top_ : step;
}

void ForcePlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), Qt::white);
  top_ = top();
  const QFontMetrics metrics(font());
  const QRectF area(58, metrics.height() + 8, width() - 74, height() - 2 * metrics.height() - 18);
  const auto toX = [&](double t) { return area.right() + (t - latest_) / kSpan * area.width(); };
  const auto toY = [&](double f) { return area.center().y() - f / top_ * area.height() / 2; };

  painter.setPen(QColor(0x4a, 0x53, 0x62));
  painter.drawText(QRectF(0, area.top(), 22, area.height()), Qt::AlignCenter, QStringLiteral("N"));
  for (const double f : {-top_, -0.5 * top_, 0.0, 0.5 * top_, top_}) {
    painter.setPen(f == 0 ? QColor(0xa8, 0xb0, 0xbc) : QColor(0xe4, 0xe8, 0xee));
    painter.drawLine(QPointF(area.left(), toY(f)), QPointF(area.right(), toY(f)));
    painter.setPen(QColor(0x4a, 0x53, 0x62));
    painter.drawText(QRectF(14, toY(f) - 8, 38, 16), Qt::AlignRight | Qt::AlignVCenter,
                     QString::number(f, 'g', 3).replace('-', QStringLiteral("−")));
  }
  for (int back = 0; back <= static_cast<int>(kSpan); ++back) {
    const double x = toX(latest_ - back);
    painter.setPen(QColor(0xe4, 0xe8, 0xee));
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
    painter.setPen(QColor(0x4a, 0x53, 0x62));
    const QString words = back == 0 ? tr("now") : QStringLiteral("−%1 s").arg(back);
    painter.drawText(QRectF(x - 30, area.bottom() + 3, 60, metrics.height()), Qt::AlignCenter,
                     words);
  }

  painter.setClipRect(area.adjusted(0, -1, 0, 1));
  painter.setRenderHint(QPainter::Antialiasing);
  const auto all = curves();
  for (std::size_t c = all.size(); c-- > 0;) {
    QPolygonF line;
    line.reserve(static_cast<int>(points_.size()));
    for (const Point& point : points_) line << QPointF(toX(point.t), toY(point.f[c]));
    painter.setPen(QPen(all[c].color, all[c].width));
    painter.drawPolyline(line);
  }
  painter.setClipping(false);

  // The legend is the read-out: names, colours and the newest values.
  double x = area.left();
  for (std::size_t c = 0; c < all.size(); ++c) {
    const double value = points_.empty() ? 0 : static_cast<double>(points_.back().f[c]);
    QString words =
        QStringLiteral("%1  %2 N").arg(QString::fromUtf8(all[c].name)).arg(value, 0, 'f', 2);
    words.replace('-', QStringLiteral("−"));
    painter.setPen(QPen(all[c].color, 3));
    painter.drawLine(QPointF(x, 4 + metrics.height() / 2.0),
                     QPointF(x + 16, 4 + metrics.height() / 2.0));
    painter.setPen(QColor(0x22, 0x28, 0x32));
    painter.drawText(QPointF(x + 22, 4 + metrics.ascent()), words);
    x += 22 + metrics.horizontalAdvance(QStringLiteral("|F|  −00.00 N")) + 16;
  }
}

} // namespace patina
