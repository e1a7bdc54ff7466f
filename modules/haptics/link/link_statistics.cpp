#include "haptics/link/link_statistics.h"

namespace patina {

std::string inhibitText(const LinkStatistics& notes) {
  const DeviceStatus status = notes.status;
  const ForceInhibit inhibit = notes.inhibit;
  if (status == DeviceStatus::reconnecting) {
    const std::string cause = notes.cause();
    return "no force: " + (cause.empty() ? "the device is being opened" : cause);
  }
  if (status == DeviceStatus::calibrating)
    return "no force: pull the handle all the way out and push it in, so that it is homed";
  if (inhibit != ForceInhibit::none) return std::string("no force: ") + text(inhibit);
  return notes.gain < 1 ? "the force is coming back" : "";
}

} // namespace patina
