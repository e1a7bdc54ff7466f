// Curves of the last five seconds, with the newest values as the legend.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include <QString>
#include <QWidget>

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
  void paintEvent(QPaintEvent* event) override;

 private:
  struct Point {
    double t;
    Values value;
  };
  float size(const Point& point) const; // of its largest value
  double top() const;
  void paintAxes(QPainter& painter, const QRectF& area) const;
  int legendWidth(std::size_t curve) const;
  void paintLegend(QPainter& painter, const QRectF& area) const;
  double toX(const QRectF& area, double t) const;
  double toY(const QRectF& area, double value) const;

  QString unit_;
  std::vector<StripCurve> curves_;
  double least_top_;
  std::deque<Point> points_;
  double latest_ = 0;
  double top_;
  bool dirty_ = true;
  bool quiet_ = false; // all that is shown is zero, and has been drawn
};

} // namespace patina
