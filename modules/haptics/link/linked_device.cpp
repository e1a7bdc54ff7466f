#include "haptics/link/linked_device.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <thread>
#include <type_traits>

#include <semaphore.h>
#include <time.h>

#include "haptics/device/realtime.h"

namespace patina {
namespace {

// A value that one thread writes and others read without waiting: a sequence lock (Boehm 2012).
template <typename T> class SeqLock {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit SeqLock(const T& value = {}) { set(value); }

  void set(const T& value) noexcept { // one writer at a time
    Words words{};
    std::memcpy(words.data(), &value, sizeof(T));
    // The version is odd during a write and is stored before the words.
    const std::uint64_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed);
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    version_.store(version + 2, std::memory_order_release);
  }

  // Returns false and leaves `value` unchanged if a write was in progress.
  bool read(T& value) const noexcept {
    const std::uint64_t version = version_.load(std::memory_order_acquire);
    if (version % 2 == 1) return false;
    Words words;
    for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
    if (version_.load(std::memory_order_relaxed) != version) return false;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
    return true;
  }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  using Words = std::array<std::uint64_t, kWords>;
  std::atomic<std::uint64_t> version_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

constexpr std::int64_t kIdle = 1'000'000; // [ns], between two exchanges without a command
constexpr std::int64_t kSecond = 1'000'000'000;

// Wake-up event between threads; posting never blocks.
class WakeEvent {
 public:
  WakeEvent() { sem_init(&semaphore_, 0, 0); }
  ~WakeEvent() { sem_destroy(&semaphore_); }
  WakeEvent(const WakeEvent&) = delete;
  WakeEvent& operator=(const WakeEvent&) = delete;
  void post() noexcept { sem_post(&semaphore_); }
  void clear() noexcept {
    while (sem_trywait(&semaphore_) == 0) {
    }
  }
  void wait(std::int64_t ns) noexcept { // waits at most `ns`
    const std::int64_t at = monotonicNs() + ns;
    const timespec until{at / kSecond, at % kSecond};
    while (sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &until) != 0 && errno == EINTR) {
    }
    clear();
  }

 private:
  sem_t semaphore_;
};

struct Wire { // Eigen's types are not trivially copyable
  double at = -1;
  double v[3] = {0, 0, 0};
};
struct StateMessage {
  double measured_at = 0;
  double position[3] = {0, 0, 0}, orientation[4] = {0, 0, 0, 1}, velocity[3] = {0, 0, 0};
  std::uint32_t buttons = 0;
  DeviceStatus status = DeviceStatus::reconnecting;
  bool has_velocity = false;
};

// Shared by both threads.
class Exchange {
 public:
  Exchange(std::unique_ptr<DeviceLink> link, const LinkedSpec& spec)
      : spec_(spec),
        loop_(std::make_unique<LinkLoop>(std::move(link), spec.guard, spec.clock, spec.notes)) {}

  DeviceState exchange(const Vec3& force) noexcept {
    command_.set({spec_.clock->now(), {force.x(), force.y(), force.z()}});
    answered_.clear();
    asked_.post();
    if (last_.status != DeviceStatus::reconnecting)
      answered_.wait(static_cast<std::int64_t>(1e9 * spec_.reply_timeout));
    StateMessage message;
    if (state_.read(message)) take(message);
    last_.age = spec_.clock->now() - measured_at_;
    // A state that is too old is not used, but this is not final.
    if (last_.status == DeviceStatus::ok && !(last_.age <= kMaxStateAge))
      last_.status = DeviceStatus::reconnecting;
    return last_;
  }

  // Returns true if the link was closed in time; a foreign library may never return.
  bool end() noexcept {
    stopping_.store(true, std::memory_order_relaxed);
    asked_.post();
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
      send(loop_->step(command));
      answered_.post();
    }
    loop_.reset(); // closes the device
    ended_.store(true, std::memory_order_release);
    answered_.post();
  }

 private:
  void take(const StateMessage& message) noexcept {
    last_.position = Vec3(message.position);
    last_.orientation = Eigen::Quaterniond(message.orientation);
    last_.velocity.reset();
    if (message.has_velocity) last_.velocity = Vec3(message.velocity);
    last_.buttons = message.buttons;
    last_.status = message.status;
    measured_at_ = message.measured_at;
  }

  void send(const DeviceState& state) noexcept {
    StateMessage message;
    message.measured_at = loop_->measuredAt();
    for (int i = 0; i < 3; ++i) message.position[i] = state.position[i];
    for (int i = 0; i < 4; ++i) message.orientation[i] = state.orientation.coeffs()[i];
    message.has_velocity = state.velocity.has_value();
    for (int i = 0; i < 3 && state.velocity; ++i) message.velocity[i] = (*state.velocity)[i];
    message.buttons = state.buttons;
    message.status = state.status;
    state_.set(message);
  }

  LinkedSpec spec_;
  std::unique_ptr<LinkLoop> loop_; // device thread only, once it runs
  SeqLock<Wire> command_;
  SeqLock<StateMessage> state_;
  WakeEvent asked_, answered_;
  std::atomic<bool> stopping_{false}, ended_{false};
  DeviceState last_{.status = DeviceStatus::reconnecting}; // servo thread only, like the next
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
      thread_.detach(); // the thread shares ownership of its data
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
