// What a texture is made of: measured heights and their harmonics along the way, the spectrum, and
// what is felt of it beside the truth. The wheel zooms along x under the pointer, a drag shifts, a
// double click shows all.
#pragma once

#include <QWidget>

#include "app/gui/widgets/graph.h"
#include "demo/demo.h"

namespace patina {

class ProfilePlot : public QWidget {
  Q_OBJECT
 public:
  explicit ProfilePlot(QWidget* parent = nullptr) : QWidget(parent) { setMinimumHeight(118); }

  void setTexture(const DemoTexture* texture);    // nullptr: none; copies what it draws
  void setTexture(const FourierTexture* texture); // the same: a period of it, and its harmonics

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  Graph* graphAt(double x);
  void zoom(const QPointF& at, double notches);
  void shift(double pixels);

  std::vector<Graph> graphs_;
  std::vector<QRectF> areas_; // of their curves, as drawn
  Graph* dragged_ = nullptr;
  double last_ = 0; // [pixel], of the drag
};

} // namespace patina
