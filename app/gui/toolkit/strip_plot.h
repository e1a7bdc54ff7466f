// Strip chart: curves of the last seconds, with the newest values as the legend. Space or its
// button holds the picture while recording goes on. The wheel or a drag holds it, too, and a double
// click follows again.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include <QHBoxLayout>
#include <QToolButton>

#include "app/gui/toolkit/plot.h"

namespace patina {

struct StripCurve {
  QString name;
  const char* color = "text"; // See theme.h.
  double width = 1.1;         // Line width [px].
  bool keeps_peak = false;    // Drawn points have the maximum since the last one.
};

class StripPlot : public PlotWidget {
  Q_OBJECT
 public:
  static constexpr std::size_t kMaxCurves = 4;
  using Values = std::array<float, kMaxCurves>; // Values beyond the number of curves are ignored.

  // The axis is symmetrical, up to min_top or more, in the unit of the values.
  StripPlot(const QString& unit, std::vector<StripCurve> curves, double min_top,
            QWidget* parent = nullptr);

  void add(double t, const Values& values); // t [s] increases.
  void clear();
  void refresh();
  QSize sizeHint() const override { return {400, 150}; }
  QSize minimumSizeHint() const override { // Includes the corner.
    return PlotWidget::minimumSizeHint() + QSize(layout()->minimumSize().width(), 0);
  }

 protected:
  void addToCorner(QWidget* widget) { // Places it next to the button.
    corner_->insertWidget(corner_->count() - 1, widget);
  }
  bool event(QEvent* event) override;

 private:
  struct Point {
    double t;
    Values value;
  };
  float size(const Point& point) const; // Largest absolute value of the point.
  void hold(bool holds);
  const std::deque<Point>& shown() const { return held_ ? *held_ : points_; }
  double top(const AxisSpan& span) const;
  void describe();

  QString unit_;
  std::vector<StripCurve> curves_;
  double min_top_;
  QHBoxLayout* corner_;
  QToolButton* holds_;
  std::deque<Point> points_;
  std::optional<std::deque<Point>> held_; // The points when the picture was held.
  double latest_ = 0, held_now_ = 0;      // [s]
  double top_;
  bool dirty_ = true;
  bool quiet_ = false; // Everything shown is zero and was drawn.
};

} // namespace patina
