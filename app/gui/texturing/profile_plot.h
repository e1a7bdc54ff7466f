// What a texture is made of: measured heights and their harmonics along the way, the spectrum, and
// what is felt of it beside the truth.
#pragma once

#include <QWidget>

#include "app/gui/widgets/graph.h"
#include "pipeline/demo.h"

namespace patina {

class ProfilePlot : public QWidget {
  Q_OBJECT
 public:
  explicit ProfilePlot(QWidget* parent = nullptr) : QWidget(parent) { setMinimumHeight(118); }

  void setTexture(const DemoTexture* texture);    // nullptr: none; copies what it draws
  void setTexture(const FourierTexture* texture); // the same: a period of it, and its harmonics

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::vector<Graph> graphs_;
};

} // namespace patina
