#include "haptics/device/device_mount.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "haptics/law/limit_stage.h"

namespace patina {
namespace {

class MountedDevice final : public Device {
 public:
  MountedDevice(std::unique_ptr<Device> device, const MountSpec& spec,
                std::shared_ptr<const MountControls> controls)
      : device_(std::move(device)), spec_(spec), controls_(std::move(controls)),
        rotation_(spec.world_from_device.linear()), offset_(spec.world_from_device.translation()) {
    const bool rigid =
        spec.world_from_device.matrix().allFinite() &&
        (rotation_ * rotation_.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-9 &&
        rotation_.determinant() > 0;
    if (!device_ || !controls_ || !rigid || !(spec.scale > 0 && std::isfinite(spec.scale)) ||
        !(spec.max_force > 0))
      throw std::invalid_argument("device mount: it needs a device, controls, a rigid pose, and a "
                                  "scale and max_force above 0");
  }

  DeviceState exchange(const Vec3& force, double dt) noexcept override {
    const bool clutched = controls_->clutched.load(std::memory_order_relaxed);
    const bool rests = held_ || clutched || !controls_->enabled.load(std::memory_order_relaxed);
    gain_ = rests ? 0 : std::min(1.0, gain_ + dt / kMountFadeTime);
    const Vec3 sent = gain_ * spec_.scale * (rotation_.transpose() * force);
    DeviceState state = device_->exchange(scaledTo(sent, spec_.max_force), dt);
    if (effectiveStatus(state) != DeviceStatus::ok || !state.position.allFinite()) return state;

    const Vec3 hand = spec_.scale * (rotation_ * state.position);
    if (held_) // also in the tick of release: the tip continues from its position
      offset_ = tip_ - hand;
    else
      tip_ = offset_ + hand;
    if (state.velocity)
      state.velocity = held_ ? Vec3::Zero() : Vec3(spec_.scale * (rotation_ * *state.velocity));
    state.position = tip_;
    state.orientation = Eigen::Quaterniond(rotation_) * state.orientation;
    held_ = clutched || (spec_.clutch_button && (state.buttons >> *spec_.clutch_button & 1U) != 0);
    return state;
  }

 private:
  std::unique_ptr<Device> device_;
  MountSpec spec_;
  std::shared_ptr<const MountControls> controls_;
  Eigen::Matrix3d rotation_;
  Vec3 offset_; // from the hand to the tip
  Vec3 tip_ = Vec3::Zero();
  bool held_ = false; // clutched in the last reading
  double gain_ = 1;   // factor of the force
};

} // namespace

std::unique_ptr<Device> mountDevice(std::unique_ptr<Device> device, const MountSpec& spec,
                                    std::shared_ptr<const MountControls> controls) {
  return std::make_unique<MountedDevice>(std::move(device), spec, std::move(controls));
}

} // namespace patina
