#include "app/gui/widgets/graph.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/gui/widgets/words.h"
#include "app/gui/window/theme.h"

namespace patina {
namespace {

// 1, 2, 5, 10 and so on.
std::vector<double> roundIn(const AxisSpan& span) {
  std::vector<double> marks;
  if (!(span.from > 0)) return marks;
  for (double power = std::pow(10, std::floor(std::log10(span.from))); power <= span.to;
       power *= 10)
    for (const double digit : {1., 2., 5.})
      if (digit * power >= span.from && digit * power <= span.to) marks.push_back(digit * power);
  return marks;
}

} // namespace

double stepFor(double range, int count) {
  const double least = range / count, power = std::pow(10, std::floor(std::log10(least)));
  for (const double step : {1., 2., 5., 10.})
    if (step * power >= least) return step * power;
  return least;
}

std::vector<double> marksOf(const AxisSpan& span, int count, double least) {
  std::vector<double> marks;
  // Of a span of rounding alone a step would be lost in the sum.
  if (!(span.length() > 1e-9 * std::max(std::abs(span.from), std::abs(span.to)))) return marks;
  for (int most = count; marks.size() < 2 && most < count + 8; ++most) {
    const double step = std::max(stepFor(span.length(), most), least);
    marks.clear();
    for (double k = std::ceil(span.from / step - 1e-9); k * step <= span.to + 1e-9 * step; ++k)
      marks.push_back(k * step + 0.0); // no -0
  }
  return marks;
}

AxisSpan wholeOf(const Graph& graph) {
  QRectF box;
  for (const GraphCurve& curve : graph.curves) box = box.united(curve.points.boundingRect());
  return {box.left(), box.right()};
}

QRectF paintGraph(QPainter& painter, const QRectF& whole, const Graph& graph) {
  const QFontMetrics letters = painter.fontMetrics();
  const int line = letters.height();
  QRectF box;
  for (const GraphCurve& curve : graph.curves) box = box.united(curve.points.boundingRect());
  if (!(box.width() > 0) || whole.width() < 96) return {};
  double low = box.top(), high = box.bottom();
  // What differs by rounding is drawn as what does not.
  if (!(high - low > 1e-9 * std::max(std::abs(low), std::abs(high))))
    high = low + std::max(1e-9, std::abs(low));
  if (graph.logarithmic) {
    low = std::log10(low);
    low = std::floor(low);
    high = std::max(low + 1, std::ceil(std::log10(high)));
  }
  const std::vector<double> levels = marksOf({low, high}, 4, graph.logarithmic ? 1 : 0);
  if (levels.size() < 2) return {};
  const double step = levels[1] - levels[0];
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  std::vector<std::pair<double, QString>> rows;
  int widest = letters.horizontalAdvance(graph.y_unit);
  for (const double value : levels) {
    const double shown = graph.logarithmic ? std::pow(10, value) : value;
    rows.emplace_back(shown, graph.logarithmic && shown < 1
                                 ? QString::number(shown, 'g', 3)
                                 : QString::number(shown, 'f', decimals));
    widest = std::max(widest, letters.horizontalAdvance(rows.back().second));
  }
  const double margin = std::max(42, widest + 4);
  const QRectF area = whole.adjusted(margin + 4, line + 6, -10, -line - 6);
  const AxisSpan seen = graph.seen.value_or(AxisSpan{box.left(), box.right()});
  const auto xAt = [&](double x) {
    const double part = graph.logarithmic ? std::log(x / seen.from) / std::log(seen.to / seen.from)
                                          : (x - seen.from) / seen.length();
    return area.left() + part * area.width();
  };
  const auto yAt = [&](double y) {
    const double value = graph.logarithmic ? std::log10(y) : y;
    return area.bottom() - (value - low) / (high - low) * area.height();
  };
  for (const auto& [shown, words] : rows) {
    painter.setPen(ink("line"));
    painter.drawLine(QPointF(area.left(), yAt(shown)), QPointF(area.right(), yAt(shown)));
    painter.setPen(ink("quiet"));
    painter.drawText(QRectF(whole.left(), yAt(shown) - line / 2., margin, line),
                     Qt::AlignRight | Qt::AlignVCenter, words);
  }
  painter.setPen(ink("quiet"));
  painter.drawText(QRectF(whole.left(), whole.top() + 3, margin, line), Qt::AlignRight,
                   graph.y_unit);
  std::vector<double> marks = graph.logarithmic ? roundIn(seen) : std::vector<double>();
  if (marks.size() < 2)
    marks = marksOf(seen, std::clamp(static_cast<int>(area.width() / 60), 2, 8), graph.counted);
  for (const double x : marks) {
    painter.setPen(ink("quiet"));
    const QString words =
        QString::number(x) + (x == marks.back() ? kNoBreak + graph.x_unit : QString());
    const double wide = painter.fontMetrics().horizontalAdvance(words) + 2;
    const double from = std::min(xAt(x) - wide / 2, whole.right() - wide);
    painter.drawText(QRectF(from, area.bottom() + 3, wide, line), Qt::AlignCenter, words);
  }
  painter.setRenderHint(QPainter::Antialiasing);
  // A graph that is narrow has of its first name, the longest, what fits.
  constexpr int kMark = 12, kGap = 5, kApart = 12;
  double legend = area.left() + kApart / 2, room = whole.right() - legend; // clear of the unit
  for (const GraphCurve& curve : graph.curves)
    room -= kMark + kGap + kApart +
            (&curve == &graph.curves.front() ? 0 : letters.horizontalAdvance(curve.name));
  for (const GraphCurve& curve : graph.curves) {
    painter.setPen(QPen(ink(curve.ink), graph.bars ? 2 : 1.4));
    painter.setClipRect(area.adjusted(-1, -2, 1, 1));
    QPolygonF drawn;
    for (const QPointF& point : curve.points) {
      const QPointF at(xAt(point.x()), yAt(point.y()));
      if (graph.bars) painter.drawLine(at, QPointF(at.x(), area.bottom()));
      drawn << at;
    }
    if (!graph.bars) painter.drawPolyline(drawn);
    painter.setClipping(false);
    painter.setPen(QPen(ink(curve.ink), 3));
    painter.drawLine(QPointF(legend, whole.top() + line / 2. + 3),
                     QPointF(legend + kMark, whole.top() + line / 2. + 3));
    painter.setPen(ink("text"));
    const QString words =
        &curve == &graph.curves.front()
            ? letters.elidedText(curve.name, Qt::ElideRight, std::max(0, static_cast<int>(room)))
            : curve.name;
    painter.drawText(QPointF(legend + kMark + kGap, whole.top() + letters.ascent() + 3), words);
    legend += kMark + kGap + kApart + letters.horizontalAdvance(words);
  }
  return area;
}

} // namespace patina
