// The force of the last five seconds.
#pragma once

#include <deque>
#include <vector>

#include <QWidget>

#include "scene/tool_sample.h"

namespace patina {

class ForcePlot : public QWidget {
  Q_OBJECT
 public:
  explicit ForcePlot(QWidget* parent = nullptr);

  void add(const std::vector<ToolSample>& samples);
  void clear();
  // Repaints if there is something new to see.
  void refresh();
  QSize sizeHint() const override { return {600, 150}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  struct Point {
    double t;
    float f[4]; // |F|, Fx, Fy, Fz [N]
  };
  double top() const;

  std::deque<Point> points_;
  double latest_ = 0;
  double top_ = 0.5; // of the axis [N]
  bool dirty_ = true;
  bool quiet_ = false; // all that is shown is zero, and has been drawn
};

} // namespace patina
