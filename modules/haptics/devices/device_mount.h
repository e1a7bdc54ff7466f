// How a device stands in the world: calibration, workspace scale, clutch, enable.
#pragma once

#include <atomic>
#include <limits>
#include <memory>
#include <optional>

#include "haptics/devices/device.h"

namespace patina {

inline constexpr double kMountFadeTime = 0.1; // [s]

// tip = world_from_device (scale * p). Forces go back by the transpose, scale R^T F, so that the
// device's power is the tip's: F_d v_d = F v. A stiffness K is felt as scale^2 K.
struct MountSpec {
  Pose world_from_device = Pose::Identity(); // the calibration: directions, and where p = 0 lies
  double scale = 1;                          // metres in the world for one of the device
  double max_force = std::numeric_limits<double>::infinity(); // [N], of the device: scaled down
  std::optional<unsigned> clutch_button{};                    // held: clutched
};

// Any thread.
struct MountControls {
  std::atomic<bool> enabled{true};   // no: the tip follows, without force
  std::atomic<bool> clutched{false}; // the device moves, without force, and the tip stays
};

// The device in the world's frame. After a clutch the tip goes on from where it stayed. Force comes
// back over kMountFadeTime, because it would step where the tip is in contact. A clutch holds the
// place alone: the orientation is always the hand's. A state that is not ok or not
// finite is passed on as it is. Throws std::invalid_argument without a device or controls, for a
// pose that is not rigid, and unless scale and max_force are above 0.
std::unique_ptr<Device> mountDevice(std::unique_ptr<Device> device, const MountSpec& spec,
                                    std::shared_ptr<const MountControls> controls);

} // namespace patina
