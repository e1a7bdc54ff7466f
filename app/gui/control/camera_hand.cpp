#include "app/gui/control/camera_hand.h"

#include "haptics/devices/spacemouse/spacemouse.h"
#include "usb/usb_bus.h"
#include "visualization/view/camera.h"

namespace patina {
namespace {

// A cap that is pushed all the way: picture heights and radians a second.
const SpaceMouseSpec kPace{.speed = 0.8, .turn_speed = 1.5};

} // namespace

CameraHand::CameraHand() : CameraHand(usbOpener("3Dconnexion SpaceMouse")) {}

CameraHand::CameraHand(std::function<std::unique_ptr<UsbTransport>()> open) {
  const LinkedSpec spec{.notes = notes_};
  device_ = makeLinkedDevice(makeSpaceMouseLink(std::move(open), kPace, spec.clock), spec);
}

bool CameraHand::move(vtkCamera& camera) {
  const DeviceState state = device_->exchange(Vec3::Zero(), 0);
  if (judge(state) != DeviceStatus::ok) {
    last_.reset();
    return false;
  }
  const DeviceState before = last_.value_or(state);
  last_ = state;
  const Vec3 shift = state.position - before.position;
  const Eigen::AngleAxisd turn(state.orientation * before.orientation.conjugate());
  if (shift == Vec3::Zero() && turn.angle() == 0) return false;
  carry(camera, shift, turn.angle() * turn.axis());
  return true;
}

std::string CameraHand::problem() const {
  return notes_->status == DeviceStatus::away ? notes_->cause() : "";
}

} // namespace patina
