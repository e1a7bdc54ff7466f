#include "haptics/device/device.h"

namespace patina {

const char* text(DeviceStatus status) noexcept {
  switch (status) {
  case DeviceStatus::ok:
    return "answers";
  case DeviceStatus::calibrating:
    return "is being calibrated";
  case DeviceStatus::repositioning:
    return "is lifted off the surface";
  case DeviceStatus::reconnecting:
    return "is disconnected: its force returns when it is back";
  case DeviceStatus::timed_out:
    return "has stopped answering";
  case DeviceStatus::protocol_error:
    return "sends replies that cannot be read";
  case DeviceStatus::gone:
    break;
  }
  return "is gone: unplugged, or taken by another program";
}

DeviceStatus effectiveStatus(const DeviceState& state) noexcept {
  if (state.status != DeviceStatus::ok) return state.status;
  return state.age <= kMaxStateAge ? DeviceStatus::ok : DeviceStatus::timed_out;
}

} // namespace patina
