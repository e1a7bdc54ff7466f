// The two strips below the picture, fed with the servo's ticks.
#pragma once

#include <vector>

#include <QCheckBox>
#include <QToolButton>

#include "app/gui/panels/strip_plot.h"
#include "app/gui/servo/energy_meter.h"
#include "scene/tool_sample.h"

namespace patina {

class ForcePlot : public StripPlot {
  Q_OBJECT
 public:
  explicit ForcePlot(QWidget* parent = nullptr);
  void addSamples(const std::vector<ToolSample>& samples);
};

// Energy taken by the surface since it was last set to zero, and its lowest value, in mJ.
class EnergyPlot : public StripPlot {
  Q_OBJECT
 public:
  explicit EnergyPlot(QWidget* parent = nullptr);
  // `dropped` counts what the servo's ring has lost so far.
  void addSamples(const std::vector<ToolSample>& samples, std::size_t dropped);
  void restart(); // another scene: nothing is shown, and the energy is zero

 private:
  EnergyMeter meter_;
  std::size_t dropped_ = 0;
};

} // namespace patina
