// A small graph: curves or bars over an axis, with grid, numbers and a legend.
#pragma once

#include <optional>
#include <vector>

#include <QPainter>
#include <QPolygonF>
#include <QString>

#include "app/gui/widgets/axis_zoom.h"

namespace patina {

struct GraphCurve {
  QString name;
  const char* ink; // see theme.h
  QPolygonF points;
};
struct Graph {
  QString x_unit, y_unit;
  bool bars = false, logarithmic = false;
  std::vector<GraphCurve> curves;
  bool counted = false;              // along x are whole numbers
  std::optional<AxisSpan> seen = {}; // along x; absent: all
};
// Along x.
AxisSpan wholeOf(const Graph& graph);
// Where the curves are. Nothing, and a null rectangle, where they have no width or there is no
// room.
QRectF paintGraph(QPainter& painter, const QRectF& whole, const Graph& graph);

// Round places to be marked along an axis, about `count` of them: two at least where there is a
// span of finite ends and `least`, how far they are apart at least, leaves room for them.
std::vector<double> marksOf(const AxisSpan& span, int count, double least = 0);
// Steps of 1, 2, 5 so that at most `count` of them fit into a range.
double stepFor(double range, int count);

} // namespace patina
