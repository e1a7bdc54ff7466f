// What the error is about the place where the path lies: by shifts and turns, and over the mesh.
// Looked for behind the window.
#pragma once

#include "app/gui/aligning/basin_plot.h"
#include "app/gui/window/background.h"

namespace patina {

class AroundPlace : public QObject {
  Q_OBJECT
 public:
  explicit AroundPlace(const Alignment& alignment) : alignment_(alignment) {}

  BasinPlot* plot() const { return plot_; }
  // One a vertex of the mesh [m]; empty: not known of where the path lies.
  const std::vector<float>& error() const { return error_; }
  void look();   // about where the path lies now
  void forget(); // it has left its place

 signals:
  void errorChanged();

 private:
  const Alignment& alignment_;
  Background job_;
  BasinPlot* plot_ = new BasinPlot;
  std::vector<float> error_;
};

} // namespace patina
