#include "app/gui/texturing/profile_plot.h"

#include <algorithm>
#include <cmath>

#include <QPainter>

#include "app/gui/window/theme.h"

namespace patina {
namespace {

constexpr double kMilli = 1e3, kMicro = 1e6;
constexpr double kFineStep = 0.1e-3;       // of what is drawn along the way [m]
constexpr double kLeastAmplitude = 0.1e-6; // of what is drawn of the spectrum [m]

QRectF boundsOf(const QPolygonF& points) {
  return points.boundingRect();
}

// Steps of 1, 2, 5 so that at most `count` of them fit.
double stepFor(double range, int count) {
  const double least = range / count, power = std::pow(10, std::floor(std::log10(least)));
  for (const double step : {1., 2., 5., 10.})
    if (step * power >= least) return step * power;
  return least;
}

} // namespace

void ProfilePlot::setTexture(const DemoTexture* texture) {
  graphs_.clear();
  if (texture != nullptr) {
    const FittedTexture& fitted = texture->scanned.fitted;
    Graph heights{tr("mm"),
                  tr("µm"),
                  false,
                  false,
                  {{tr("measured"), "quiet", {}}, {tr("harmonics"), "accent", {}}}};
    double last = -1;
    for (const ScanHeight& height : texture->scanned.heights) {
      const double along = height.point.along;
      if (along < last + kFineStep) continue;
      last = along;
      heights.curves[0].points << QPointF(kMilli * along, kMicro * height.point.height);
      heights.curves[1].points << QPointF(kMilli * along,
                                          kMicro * patina::height(fitted.texture, along));
    }
    Graph spectrum{tr("mm"), tr("µm"), true, true, {{tr("spectrum"), "accent", {}}}};
    for (std::size_t j = 0; j < fitted.texture.series.a.size(); ++j) {
      const double amplitude = std::hypot(fitted.texture.series.a[j], fitted.texture.series.b[j]);
      if (amplitude < kLeastAmplitude) continue;
      spectrum.curves[0].points << QPointF(
          kMilli * period(fitted.texture) / static_cast<double>(j + 1), kMicro * amplitude);
    }
    graphs_ = {heights, spectrum};
    if (!texture->felt.empty()) {
      Graph felt{tr("mm"),
                 tr("N"),
                 false,
                 false,
                 {{tr("true surface"), "quiet", {}}, {tr("felt"), "accent", {}}}};
      for (std::size_t i = 0; i < texture->felt.size(); i += 3) {
        const FeltPoint& point = texture->felt[i];
        felt.curves[0].points << QPointF(kMilli * point.along, point.truth.dot(point.outward));
        felt.curves[1].points << QPointF(kMilli * point.along, point.felt.dot(point.outward));
      }
      graphs_.push_back(felt);
    }
  }
  update();
}

void ProfilePlot::paintGraph(QPainter& painter, const QRectF& whole, const Graph& graph) const {
  const int line = QFontMetrics(font()).height();
  const QRectF area = whole.adjusted(46, line + 6, -10, -line - 6);
  QRectF box;
  for (const Curve& curve : graph.curves) box = box.united(boundsOf(curve.points));
  if (!(box.width() > 0) || area.width() < 40) return;
  double low = box.top(), high = box.bottom();
  if (graph.logarithmic) {
    low = std::log10(low);
    high = std::ceil(std::log10(high));
    low = std::floor(low);
  }
  const auto xAt = [&](double x) {
    const double part = graph.logarithmic
                            ? std::log(x / box.left()) / std::log(box.right() / box.left())
                            : (x - box.left()) / box.width();
    return area.left() + part * area.width();
  };
  const auto yAt = [&](double y) {
    const double value = graph.logarithmic ? std::log10(y) : y;
    return area.bottom() - (value - low) / (high - low) * area.height();
  };
  const double step = graph.logarithmic ? 1 : stepFor(high - low, 4);
  for (double value = std::ceil(low / step) * step; value <= high + 1e-9; value += step) {
    const double shown = graph.logarithmic ? std::pow(10, value) : value;
    painter.setPen(ink("line"));
    painter.drawLine(QPointF(area.left(), yAt(shown)), QPointF(area.right(), yAt(shown)));
    painter.setPen(ink("quiet"));
    painter.drawText(QRectF(whole.left(), yAt(shown) - line / 2., 42, line),
                     Qt::AlignRight | Qt::AlignVCenter,
                     graph.logarithmic && shown >= 1 ? QString::number(shown, 'f', 0)
                                                     : QString::number(shown, 'g', 3));
  }
  std::vector<double> marks;
  if (graph.logarithmic)
    marks = {0.2, 0.5, 1, 2, 5, 10};
  else
    for (double x = std::ceil(box.left() / 10) * 10; x <= box.right(); x += 10) marks.push_back(x);
  for (const double x : marks) {
    if (x < box.left() || x > box.right()) continue;
    painter.setPen(ink("quiet"));
    painter.drawText(QRectF(xAt(x) - 30, area.bottom() + 3, 60, line), Qt::AlignCenter,
                     QString::number(x) + (x == marks.back() ? ' ' + graph.x_unit : QString()));
  }
  painter.setRenderHint(QPainter::Antialiasing);
  double legend = area.left();
  for (const Curve& curve : graph.curves) {
    painter.setPen(QPen(ink(curve.ink), graph.bars ? 2 : 1.4));
    QPolygonF drawn;
    for (const QPointF& point : curve.points) {
      const QPointF at(xAt(point.x()), yAt(point.y()));
      if (graph.bars) painter.drawLine(at, QPointF(at.x(), area.bottom()));
      drawn << at;
    }
    if (!graph.bars) painter.drawPolyline(drawn);
    painter.setPen(QPen(ink(curve.ink), 3));
    painter.drawLine(QPointF(legend, whole.top() + line / 2. + 3),
                     QPointF(legend + 12, whole.top() + line / 2. + 3));
    painter.setPen(ink("text"));
    const QString words = curve.name + (graph.curves.size() == 1 || &curve == &graph.curves.back()
                                            ? " [" + graph.y_unit + "]"
                                            : QString());
    painter.drawText(QPointF(legend + 17, whole.top() + QFontMetrics(font()).ascent() + 3), words);
    legend += 34 + QFontMetrics(font()).horizontalAdvance(words);
  }
}

void ProfilePlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), ink("card"));
  const double wide = width() / std::max<double>(1, static_cast<double>(graphs_.size()));
  for (std::size_t i = 0; i < graphs_.size(); ++i)
    paintGraph(painter, QRectF(wide * static_cast<double>(i), 0, wide, height()), graphs_[i]);
}

} // namespace patina
