// A small graph: curves or bars over an axis, with grid, numbers and a legend.
#pragma once

#include <vector>

#include <QPainter>
#include <QPolygonF>
#include <QString>

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
  bool counted = false; // along x are whole numbers
};
// Nothing where its curves have no width or there is no room.
void paintGraph(QPainter& painter, const QRectF& whole, const Graph& graph);

// Steps of 1, 2, 5 so that at most `count` of them fit into a range.
double stepFor(double range, int count);

} // namespace patina
