// The energy that the surface has taken from the hand, from the servo's ticks.
#pragma once

#include <optional>

#include "haptics/stability/energy_ledger.h"
#include "scene/tool_sample.h"

namespace patina {

// Plain data; add() every tick, in order. The force of a tick acts until the tip is where the next
// one says.
struct EnergyMeter {
  bool from_each_touch = false; // begins at zero when a force begins
  EnergyLedger ledger;

  void add(const ToolSample& sample);
  void skip() { before_.reset(); } // ticks are missing: what happened there is not counted

 private:
  std::optional<ToolSample> before_;
};

} // namespace patina
