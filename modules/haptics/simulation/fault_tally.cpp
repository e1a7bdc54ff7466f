#include "haptics/simulation/fault_tally.h"

namespace patina {

void FaultTally::add(const Exchange& exchange) noexcept {
  if (last_) ++*last_;
  last_ = nullptr;
  if (!exchange.faulty) {
    // A delayed driver may see a fault's second answer with the next exchange only.
    begun_ = exchange.injected ? &causes_.injected : nullptr;
    good_ = exchange.begun;
    return;
  }
  const bool held_up =
      exchange.ended - exchange.begun > kMaxExchange || exchange.ended - good_ > kMaxGap;
  if (exchange.injected)
    begun_ = &causes_.injected; // it would have been a fault without the row, too
  else if (!begun_)
    begun_ = held_up ? &causes_.delayed : &causes_.unexplained;
  last_ = begun_;
}

} // namespace patina
