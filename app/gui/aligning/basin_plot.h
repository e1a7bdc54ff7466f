// The error about where the path lies now: by shifts, by turns and over two shifts at once, and at
// every step that was taken by hand.
#pragma once

#include <optional>

#include <QImage>
#include <QWidget>

#include "app/gui/aligning/alignment.h"
#include "app/gui/widgets/graph.h"

namespace patina {

class BasinPlot : public QWidget {
  Q_OBJECT
 public:
  explicit BasinPlot(QWidget* parent = nullptr);

  void setBasin(const std::optional<Basin>& basin); // nullopt: of no pose yet
  void setSteps(const std::vector<double>& rms);    // [m]

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paintMap(QPainter& painter, const QRectF& whole) const;

  std::vector<Graph> graphs_; // shifts, turns
  Graph steps_;
  QImage map_;
  double reach_mm_ = 0, least_mm_ = 0, most_mm_ = 0;
};

} // namespace patina
