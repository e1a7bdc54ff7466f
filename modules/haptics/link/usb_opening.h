// Converts an exception of opening a USB device into DeviceLink::Opening.
#pragma once

#include "haptics/link/device_link.h"
#include "usb/usb_bus.h"

namespace patina {

// Must be called while an exception is being handled.
inline DeviceLink::Opening failedOpening() noexcept {
  try {
    throw;
  } catch (const NotAttached& absent) {
    return {false, absent.what(), absent.notified_by_hotplug};
  } catch (const std::exception& error) {
    return {false, error.what()};
  }
}

} // namespace patina
