// Force and accelerations of the probe over the scan's time, with what is missing marked above
// them, and the cursor.
#pragma once

#include <functional>

#include <QWidget>

#include "app/gui/scanning/open_scan.h"

namespace patina {

class ScanTraces : public QWidget {
  Q_OBJECT
 public:
  explicit ScanTraces(OpenScan& scan, QWidget* parent = nullptr);
  QPoint placeOf(double t) const; // on the line of what is missing
  QSize minimumSizeHint() const override { return {300, 118}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;

 private:
  struct Curve {
    QString name;
    const char* ink;
    std::function<double(const ProbeSample&)> value;
  };
  struct Lane {
    QString unit;
    std::vector<Curve> curves;
  };
  static const std::vector<Lane>& lanes();
  const std::vector<ProbeSample>& samples() const;
  QRectF area() const;
  double toX(double t) const;
  double toTime(double x) const;
  void look(const QPointF& at); // the cursor goes there, onto a finding if one is near
  void paintFindings(QPainter& painter) const;
  void paintLane(QPainter& painter, const QRectF& whole, const Lane& lane) const;
  void paintTimes(QPainter& painter) const;

  OpenScan& scan_;
  Gap shown_{0, 1}; // [s]
};

} // namespace patina
