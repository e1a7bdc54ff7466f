#include "haptics/devices/device.h"

namespace patina {

const char* text(DeviceStatus status) noexcept {
  switch (status) {
  case DeviceStatus::ok:
    return "answers";
  case DeviceStatus::calibrating:
    return "is being calibrated";
  case DeviceStatus::lifted:
    return "is lifted off the surface";
  case DeviceStatus::away:
    return "is away: it is felt again when it is back";
  case DeviceStatus::silent:
    return "has stopped answering";
  case DeviceStatus::garbled:
    return "answers what cannot be read";
  case DeviceStatus::gone:
    break;
  }
  return "is gone: unplugged, or taken by another program";
}

DeviceStatus judge(const DeviceState& state) noexcept {
  if (state.status != DeviceStatus::ok) return state.status;
  return state.age <= kOldestAge ? DeviceStatus::ok : DeviceStatus::silent;
}

} // namespace patina
