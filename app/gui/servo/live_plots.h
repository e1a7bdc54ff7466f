// The two strip charts below the picture, fed with the servo's ticks.
#pragma once

#include <optional>
#include <vector>

#include "app/gui/toolkit/strip_plot.h"
#include "haptics/stability/passivity_observer.h"
#include "scene/tool_sample.h"

namespace patina {

// The energy absorbed by the surface. Call add() for each tick, in order. A force acts until the
// next tick (zero-order hold).
struct EnergyMeter {
  bool from_each_touch = false; // Restarts at zero with each contact.
  PassivityObserver ledger;

  void add(const ToolSample& sample);
  void skip() { before_.reset(); } // Ticks are missing; the gap is not counted.

 private:
  std::optional<ToolSample> before_;
};

class ForcePlot : public StripPlot {
  Q_OBJECT
 public:
  explicit ForcePlot(QWidget* parent = nullptr);
  void addSamples(const std::vector<ToolSample>& samples);
};

// Energy absorbed by the surface since the last reset, and its minimum [mJ].
class EnergyPlot : public StripPlot {
  Q_OBJECT
 public:
  explicit EnergyPlot(QWidget* parent = nullptr);
  // dropped: ticks that the servo's buffer has lost so far.
  void addSamples(const std::vector<ToolSample>& samples, std::size_t dropped);
  void restart(); // Resets everything for another scene.

 private:
  EnergyMeter meter_;
  std::size_t dropped_ = 0;
};

} // namespace patina
