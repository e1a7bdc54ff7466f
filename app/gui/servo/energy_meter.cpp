#include "app/gui/servo/energy_meter.h"

namespace patina {

void EnergyMeter::add(const ToolSample& sample) {
  if (before_) {
    if (from_each_touch && before_->force.isZero(0) && !sample.force.isZero(0)) ledger = {};
    ledger.add(before_->force, sample.tip - before_->tip, 0, sample.t - before_->t);
  }
  before_ = sample;
}

} // namespace patina
