// Curves of the last seconds, with the newest values as the legend. Space or its button holds the
// picture while what comes is kept all the same; the wheel zooms the time under the pointer and a
// drag shifts it, both of a picture that is held; a double click follows again.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include <QHBoxLayout>
#include <QString>
#include <QToolButton>
#include <QWidget>

#include "app/gui/widgets/axis_zoom.h"

namespace patina {

struct StripCurve {
  QString name;
  const char* ink = "text"; // see theme.h
  double width = 1.1;       // of the line [pixel]
  bool keeps_peak = false;  // drawn points hold the highest value since the one before
};

class StripPlot : public QWidget {
  Q_OBJECT
 public:
  static constexpr std::size_t kMostCurves = 4;
  using Values = std::array<float, kMostCurves>; // those beyond the curves are not read

  // The axis is symmetrical, reaches least_top at least, and has the values' unit.
  StripPlot(const QString& unit, std::vector<StripCurve> curves, double least_top,
            QWidget* parent = nullptr);

  void add(double t, const Values& values); // t [s] increases
  void clear();
  // Repaints if there is something new to see.
  void refresh();
  QSize sizeHint() const override { return {400, 150}; }
  QSize minimumSizeHint() const override; // with its legend

 protected:
  void addToCorner(QWidget* widget); // beside the button
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  struct Point {
    double t;
    Values value;
  };
  float size(const Point& point) const; // of its largest value
  void hold(bool holds);
  const std::deque<Point>& shown() const { return held_ ? *held_ : points_; }
  double now() const {
    return held_ ? held_now_ : latest_;
  }                      // of the right end, if it is not shifted
  AxisSpan seen() const; // [s]
  AxisSpan whole() const;
  QRectF area() const;
  bool wheel(const QWheelEvent& event);
  bool drag(const QMouseEvent& event);
  double top() const;
  void paintAxes(QPainter& painter, const QRectF& area) const;
  int legendWidth(std::size_t curve) const;
  void paintLegend(QPainter& painter, const QRectF& area) const;
  double toX(const QRectF& area, double t) const;
  double toY(const QRectF& area, double value) const;

  QString unit_;
  std::vector<StripCurve> curves_;
  double least_top_;
  QHBoxLayout* corner_;
  QToolButton* holds_;
  std::deque<Point> points_;
  std::optional<std::deque<Point>> held_; // as it was when it was held
  std::optional<AxisSpan> seen_;          // absent: the last five seconds
  double latest_ = 0, held_now_ = 0;      // [s]
  std::optional<int> dragged_from_;       // [pixel]
  double top_;
  bool dirty_ = true;
  bool quiet_ = false; // all that is shown is zero, and has been drawn
};

} // namespace patina
