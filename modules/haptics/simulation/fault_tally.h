// Causes of the faulty exchanges with an emulated device.
#pragma once

#include <cstdint>

namespace patina {

// Faulty exchanges by their cause. An exchange counts for what began its row of faults: after a
// fault the driver takes no position until the line is quiet and a second position confirms the
// first, so that one late reply costs several exchanges.
struct FaultCauses {
  std::uint64_t injected = 0;    // begun by an injected fault
  std::uint64_t delayed = 0;     // begun by a delay of this machine
  std::uint64_t unexplained = 0; // neither
};

// Sorts a driver's exchanges. One thread.
class FaultTally {
 public:
  struct Exchange {
    double begun = 0, ended = 0; // [s]
    bool injected = false;       // a fault was injected since the exchange before
    bool faulty = false;
  };
  void add(const Exchange& exchange) noexcept;
  // Takes the last exchange back, which a link makes without a command before it is closed.
  void dropLast() noexcept { last_ = nullptr; }
  // All exchanges but the last one, which may still be dropped.
  const FaultCauses& causes() const noexcept { return causes_; }

  // An exchange that takes this long without an injected fault was held up: the emulated device
  // answers within 0.3 ms, and the driver waits for 2 ms, the last half of which may be missing.
  static constexpr double kMaxExchange = 1.5e-3; // [s]
  // The driver does not trust a lone position this long after the one before.
  static constexpr double kMaxGap = 4e-3; // [s]

 private:
  FaultCauses causes_;
  std::uint64_t* last_ = nullptr;  // counter of the last exchange, if it was faulty
  std::uint64_t* begun_ = nullptr; // counter of the present row of faults
  double good_ = -1;               // begin of the last exchange without a fault [s]
};

} // namespace patina
