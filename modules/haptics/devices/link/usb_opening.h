// What an opening over USB that failed says of it.
#pragma once

#include "haptics/devices/link/device_link.h"
#include "usb/usb_bus.h"

namespace patina {

// Of the std::exception that is being handled.
inline DeviceLink::Opening failedOpening() noexcept {
  try {
    throw;
  } catch (const NotAttached& absent) {
    return {false, absent.what(), absent.told};
  } catch (const std::exception& error) {
    return {false, error.what()};
  }
}

} // namespace patina
