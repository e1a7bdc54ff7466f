// Pose of a device in the world: calibration, workspace scale, clutch, enable.
#pragma once

#include <atomic>
#include <limits>
#include <memory>
#include <optional>

#include "haptics/device/device.h"

namespace patina {

inline constexpr double kMountFadeTime = 0.1; // [s]

// tip = world_from_device (scale * p). Forces are mapped by the transpose, scale R^T F, so that
// power is conserved: F_d v_d = F v. The hand perceives a stiffness K as scale^2 K.
struct MountSpec {
  Pose world_from_device = Pose::Identity(); // calibration: directions and origin
  double scale = 1;                          // metres in the world per metre of the device
  double max_force =
      std::numeric_limits<double>::infinity(); // limit of the device's force, scaled down [N]
  std::optional<unsigned> clutch_button{};     // pressed: clutched
};

// Controls that any thread may set.
struct MountControls {
  std::atomic<bool> enabled{true};   // false: the tip follows without force
  std::atomic<bool> clutched{false}; // true: the device moves without force, the tip stays
};

// Maps the device to the world frame. After a clutch the tip continues from its position, and the
// force returns over kMountFadeTime to avoid a step in contact. The clutch holds the position only;
// the orientation always follows the hand. Passes on states that are not ok or not finite
// unchanged. Throws std::invalid_argument without a device or controls, for a pose that is not
// rigid, and unless scale and max_force are positive.
std::unique_ptr<Device> mountDevice(std::unique_ptr<Device> device, const MountSpec& spec,
                                    std::shared_ptr<const MountControls> controls);

} // namespace patina
