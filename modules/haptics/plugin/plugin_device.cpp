#include "haptics/plugin/plugin_device.h"

#include <cmath>
#include <limits>
#include <pthread.h>

#include "haptics/device/realtime.h"
#include "haptics/plugin/plugin_library.h"

namespace patina {
namespace {

constexpr double kMaxPosition = 10; // [m]
constexpr int kPriority = 40;       // below the servo's 50, so that a busy plug-in cannot block it
constexpr const char* kThrows = "the plug-in threw an exception: it must return an error instead";

class PluginLink final : public DeviceLink {
 public:
  PluginLink(const patina_device& plugin, std::string argument)
      : plugin_(plugin), argument_(std::move(argument)) {}
  ~PluginLink() override { close(); }

  Opening open() noexcept override {
    if (broken_) return {false, kThrows};
    yield();
    char why[256] = {};
    try {
      device_ = plugin_.open(argument_.c_str(), why, sizeof why - 1);
    } catch (...) {
      broken_ = true;
      return {false, kThrows};
    }
    why[sizeof why - 1] = 0;
    last_ = monotonicNs();
    if (device_) return {true};
    return {false, *why ? "the plug-in cannot be opened: " + std::string(why)
                        : "the plug-in cannot be opened and gives no reason"};
  }

  DeviceState exchange(const Vec3& force) noexcept override {
    if (device_ == nullptr) return {.status = DeviceStatus::gone};
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    patina_device_state reported{{kNone, kNone, kNone}, {1, 0, 0, 0}, {0, 0, 0}, 0, 0, 0, 0};
    const std::int64_t before = monotonicNs();
    const double dt = 1e-9 * static_cast<double>(before - last_);
    last_ = before;
    try {
      if (plugin_.exchange(device_, force.data(), dt, &reported) != 0)
        return {.status = DeviceStatus::timed_out};
    } catch (...) { // violates the interface; the device is not closed
      broken_ = true;
      device_ = nullptr;
      return {.status = DeviceStatus::gone};
    }
    const double took = 1e-9 * static_cast<double>(monotonicNs() - before);
    return took > kMaxPluginTime ? DeviceState{.status = DeviceStatus::timed_out}
                                 : judged(reported);
  }

  void close() noexcept override {
    try {
      if (device_) plugin_.close(device_);
    } catch (...) {
      broken_ = true;
    }
    device_ = nullptr;
  }

 private:
  static void yield() noexcept {
    int policy = 0;
    sched_param lower{};
    if (::pthread_getschedparam(::pthread_self(), &policy, &lower) != 0 || policy != SCHED_FIFO)
      return;
    lower.sched_priority = kPriority;
    ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &lower);
  }

  static DeviceState judged(const patina_device_state& reported) noexcept {
    const Vec3 position(reported.position), velocity(reported.velocity);
    const Eigen::Quaterniond turn(reported.orientation[0], reported.orientation[1],
                                  reported.orientation[2], reported.orientation[3]);
    const double length = turn.norm();
    if (reported.status == PATINA_DEVICE_GONE) return {.status = DeviceStatus::gone};
    const bool sound = position.allFinite() && position.cwiseAbs().maxCoeff() < kMaxPosition &&
                       std::abs(length - 1) < 1e-3 &&
                       (!reported.has_velocity || velocity.allFinite()) && reported.age >= 0 &&
                       reported.status <= PATINA_DEVICE_GONE;
    if (!sound) return {.status = DeviceStatus::protocol_error};
    DeviceState state;
    state.position = position;
    state.orientation = Eigen::Quaterniond(turn.coeffs() / length);
    if (reported.has_velocity) state.velocity = velocity;
    state.buttons = reported.buttons;
    if (reported.status == PATINA_DEVICE_CALIBRATING) state.status = DeviceStatus::calibrating;
    state.age = reported.age;
    return state;
  }

  const patina_device& plugin_;
  const std::string argument_;
  void* device_ = nullptr;
  std::int64_t last_ = 0; // [ns]
  bool broken_ = false;
};

} // namespace

std::unique_ptr<DeviceLink> makePluginLink(const patina_device& plugin, std::string argument) {
  return std::make_unique<PluginLink>(plugin, std::move(argument));
}

std::unique_ptr<Device> makePluginDevice(std::string_view device, LinkedSpec spec) {
  PluginName reported = pluginName(device);
  const patina_device& plugin = loadedPlugin(reported.name);
  spec.guard = guardFor(described(reported.name, plugin).limits);
  return makeLinkedDevice(makePluginLink(plugin, std::move(reported.argument)), spec);
}

} // namespace patina
