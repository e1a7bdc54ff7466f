#include "haptics/devices/link/link_notes.h"

namespace patina {

std::string heldBack(const LinkNotes& notes) {
  const DeviceStatus status = notes.status;
  const Hold hold = notes.hold;
  if (status == DeviceStatus::away) {
    const std::string cause = notes.cause();
    return "no force: " + (cause.empty() ? "the device is being opened" : cause);
  }
  if (status == DeviceStatus::calibrating)
    return "no force: pull the handle all the way out and push it in, so that it is homed";
  if (hold != Hold::none) return std::string("no force: ") + text(hold);
  return notes.gain < 1 ? "the force is coming back" : "";
}

} // namespace patina
