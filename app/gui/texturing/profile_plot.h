// What a texture is made of: measured heights and their harmonics along the way, the spectrum, and
// what is felt of it beside the truth.
#pragma once

#include <functional>

#include <QWidget>

#include "pipeline/demo.h"

namespace patina {

class ProfilePlot : public QWidget {
  Q_OBJECT
 public:
  explicit ProfilePlot(QWidget* parent = nullptr) : QWidget(parent) { setMinimumHeight(118); }

  void setTexture(const DemoTexture* texture); // nullptr: none; copies what it draws

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  struct Curve {
    QString name;
    const char* ink;
    QPolygonF points;
  };
  struct Graph {
    QString x_unit, y_unit;
    bool bars = false, logarithmic = false;
    std::vector<Curve> curves;
  };
  void paintGraph(QPainter& painter, const QRectF& whole, const Graph& graph) const;

  std::vector<Graph> graphs_;
};

} // namespace patina
