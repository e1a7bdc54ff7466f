// The brush's weight from its middle to its rim, as a small curve.
#pragma once

#include <QWidget>

#include "scene/stroke.h"

namespace patina {

class BrushCurve : public QWidget {
 public:
  explicit BrushCurve(QWidget* parent = nullptr);
  void setBrush(const Brush& brush);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Brush brush_;
};

} // namespace patina
