#include "haptics/devices/link/linked_device.h"

#include <atomic>
#include <cerrno>
#include <semaphore.h>
#include <thread>
#include <time.h>

#include "core/latest_value.h"
#include "haptics/servo/realtime.h"

namespace patina {
namespace {

constexpr std::int64_t kIdle = 1'000'000; // [ns], between two turns without a command
constexpr std::int64_t kSecond = 1'000'000'000;

// A token of a thread to another; posting it never waits.
class Bell {
 public:
  Bell() { sem_init(&bell_, 0, 0); }
  ~Bell() { sem_destroy(&bell_); }
  Bell(const Bell&) = delete;
  Bell& operator=(const Bell&) = delete;
  void ring() noexcept { sem_post(&bell_); }
  void hush() noexcept {
    while (sem_trywait(&bell_) == 0) {
    }
  }
  void wait(std::int64_t ns) noexcept { // at most so long
    const std::int64_t at = monotonicNs() + ns;
    const timespec until{at / kSecond, at % kSecond};
    while (sem_clockwait(&bell_, CLOCK_MONOTONIC, &until) != 0 && errno == EINTR) {
    }
    hush();
  }

 private:
  sem_t bell_;
};

struct Wire { // of Eigen's, only the numbers are trivially copyable
  double at = -1;
  double v[3] = {0, 0, 0};
};
struct Told {
  double measured_at = 0;
  double position[3] = {0, 0, 0}, orientation[4] = {0, 0, 0, 1}, velocity[3] = {0, 0, 0};
  std::uint32_t buttons = 0;
  DeviceStatus status = DeviceStatus::away;
  bool has_velocity = false;
};

// Of both threads.
class Exchange {
 public:
  Exchange(std::unique_ptr<DeviceLink> link, const LinkedSpec& spec)
      : spec_(spec),
        loop_(std::make_unique<LinkLoop>(std::move(link), spec.guard, spec.clock, spec.notes)) {}

  DeviceState exchange(const Vec3& force) noexcept {
    command_.set({spec_.clock->now(), {force.x(), force.y(), force.z()}});
    answered_.hush();
    asked_.ring();
    if (last_.status != DeviceStatus::away)
      answered_.wait(static_cast<std::int64_t>(1e9 * spec_.answer_wait));
    Told told;
    if (told_.read(told)) take(told);
    last_.age = spec_.clock->now() - measured_at_;
    // Away or not, what is too old is not felt, and it is not for good.
    if (last_.status == DeviceStatus::ok && !(last_.age <= kOldestAge))
      last_.status = DeviceStatus::away;
    return last_;
  }

  // Whether it has closed within a while: another's library may never return.
  bool end() noexcept {
    stopping_.store(true, std::memory_order_relaxed);
    asked_.ring();
    for (int i = 0; i < 1000 && !ended_.load(std::memory_order_acquire); ++i) answered_.wait(kIdle);
    return ended_.load(std::memory_order_acquire);
  }

  void run() noexcept {
    requestRealtime();
    LinkCommand command;
    while (!stopping_.load(std::memory_order_relaxed)) {
      asked_.wait(kIdle);
      Wire wire;
      if (command_.read(wire)) command = {Vec3(wire.v), wire.at};
      tell(loop_->step(command));
      answered_.ring();
    }
    loop_.reset(); // closes
    ended_.store(true, std::memory_order_release);
    answered_.ring();
  }

 private:
  void take(const Told& told) noexcept {
    last_.position = Vec3(told.position);
    last_.orientation = Eigen::Quaterniond(told.orientation);
    last_.velocity.reset();
    if (told.has_velocity) last_.velocity = Vec3(told.velocity);
    last_.buttons = told.buttons;
    last_.status = told.status;
    measured_at_ = told.measured_at;
  }

  void tell(const DeviceState& state) noexcept {
    Told told;
    told.measured_at = loop_->measuredAt();
    for (int i = 0; i < 3; ++i) told.position[i] = state.position[i];
    for (int i = 0; i < 4; ++i) told.orientation[i] = state.orientation.coeffs()[i];
    told.has_velocity = state.velocity.has_value();
    for (int i = 0; i < 3 && state.velocity; ++i) told.velocity[i] = (*state.velocity)[i];
    told.buttons = state.buttons;
    told.status = state.status;
    told_.set(told);
  }

  LinkedSpec spec_;
  std::unique_ptr<LinkLoop> loop_; // the thread's, as soon as it runs
  LatestValue<Wire> command_;
  LatestValue<Told> told_;
  Bell asked_, answered_;
  std::atomic<bool> stopping_{false}, ended_{false};
  DeviceState last_{.status = DeviceStatus::away}; // the servo's, as the next
  double measured_at_ = 0;
};

class LinkedDevice final : public Device {
 public:
  LinkedDevice(std::unique_ptr<DeviceLink> link, const LinkedSpec& spec)
      : shared_(std::make_shared<Exchange>(std::move(link), spec)),
        thread_([shared = shared_] { shared->run(); }) {}
  ~LinkedDevice() override {
    if (shared_->end())
      thread_.join();
    else
      thread_.detach(); // which keeps what it needs
  }
  DeviceState exchange(const Vec3& force, double) noexcept override {
    return shared_->exchange(force);
  }

 private:
  const std::shared_ptr<Exchange> shared_;
  std::thread thread_;
};

} // namespace

std::unique_ptr<Device> makeLinkedDevice(std::unique_ptr<DeviceLink> link, const LinkedSpec& spec) {
  return std::make_unique<LinkedDevice>(std::move(link), spec);
}

} // namespace patina
