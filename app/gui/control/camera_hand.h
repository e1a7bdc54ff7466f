// A SpaceMouse that moves the camera, whatever else feels.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include <vtkCamera.h>

#include "haptics/devices/link/linked_device.h"
#include "usb/usb_transport.h"

namespace patina {

// What is looked at goes with the cap, as if it were held in the hand. One thread's.
class CameraHand {
 public:
  // Whatever is plugged in, when it is; or, through `open`, an emulated one.
  CameraHand();
  explicit CameraHand(std::function<std::unique_ptr<UsbTransport>()> open);
  // As far as the cap was pushed and turned since the last call; false: not at all. Waits for half
  // a millisecond at most.
  bool move(vtkCamera& camera);
  std::string problem() const; // one line, why it does not move anything; empty: it does

 private:
  std::shared_ptr<LinkNotes> notes_ = std::make_shared<LinkNotes>();
  std::unique_ptr<Device> device_;
  std::optional<DeviceState> last_; // absent: it was away
};

} // namespace patina
