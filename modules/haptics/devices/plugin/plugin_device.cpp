#include "haptics/devices/plugin/plugin_device.h"

#include <cmath>
#include <ctime>
#include <future>
#include <limits>
#include <pthread.h>
#include <semaphore.h>
#include <thread>

#include "core/error.h"
#include "core/newest.h"
#include "haptics/devices/plugin/plugin_library.h"
#include "haptics/servo/realtime.h"
#include "haptics/stages/limit_stage.h"

namespace patina {
namespace {

constexpr std::int64_t kPeriod = 2'000'000;  // [ns]: how long the plug-in rests without a servo
constexpr std::int64_t kOverrun = 5'000'000; // [ns]
constexpr double kFarthest = 10;             // [m]
constexpr double kFade = 0.25;               // [s]: of the force, after it was none
constexpr auto kPatience = std::chrono::seconds(1);
constexpr int kPriority = 40; // below the servo's: a plug-in that spins takes nothing from it

struct Command {
  Vec3 force = Vec3::Zero();
  std::int64_t at = 0; // [ns]
};
struct Answer {
  DeviceState state{};
  std::int64_t at = 0; // [ns]: when the position was measured
  bool sound = true;   // whether the last answer was one
  bool gone = false;
};

struct Semaphore {
  Semaphore() { ::sem_init(&value, 0, 0); }
  ~Semaphore() { ::sem_destroy(&value); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;
  void post() noexcept { ::sem_post(&value); }
  void waitFor(std::int64_t ns) noexcept {
    timespec until{};
    ::clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += ns;
    until.tv_sec += until.tv_nsec / 1'000'000'000;
    until.tv_nsec %= 1'000'000'000;
    ::sem_clockwait(&value, CLOCK_MONOTONIC, &until);
    while (::sem_trywait(&value) == 0) { // what was overtaken
    }
  }
  sem_t value;
};

// Of both threads; the plug-in's keeps it alive where it outlives the device.
struct Shared {
  const patina_device* plugin = nullptr;
  std::string name, argument;
  double max_force = 0; // [N]
  Newest<Command> command;
  Newest<Answer> answer;
  Semaphore wake;
  std::atomic<bool> stopping{false};
};

// Whether it is one; then it is in `answer`.
bool take(const patina_device_state& told, std::int64_t now, Answer& answer) noexcept {
  const Vec3 position(told.position), velocity(told.velocity);
  const Eigen::Quaterniond turn(told.orientation[0], told.orientation[1], told.orientation[2],
                                told.orientation[3]);
  const double length = turn.norm();
  const bool sound = position.allFinite() && position.cwiseAbs().maxCoeff() < kFarthest &&
                     std::abs(length - 1) < 1e-3 && (!told.has_velocity || velocity.allFinite()) &&
                     told.age >= 0 && told.age < 1e3 && told.status <= PATINA_DEVICE_GONE;
  if (!sound) return false;
  answer.state.position = position;
  answer.state.orientation = Eigen::Quaterniond(turn.coeffs() / length);
  answer.state.velocity = told.has_velocity ? std::optional(velocity) : std::nullopt;
  answer.state.buttons = told.buttons;
  answer.state.status =
      told.status == PATINA_DEVICE_CALIBRATING ? DeviceStatus::calibrating : DeviceStatus::ok;
  answer.gone = told.status == PATINA_DEVICE_GONE;
  answer.at = now - static_cast<std::int64_t>(1e9 * told.age);
  return true;
}

void exchangeOnce(Shared& shared, void* device, bool ending, std::int64_t& last, Answer& answer) {
  const Command command = shared.command.get();
  std::int64_t now = monotonicNs();
  const bool rests = ending || !answer.sound || now - command.at > kOverrun;
  const Vec3 force = rests ? Vec3(Vec3::Zero()) : command.force;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  patina_device_state told{{kNone, kNone, kNone}, {1, 0, 0, 0}, {0, 0, 0}, 0, 0, 0, 0};
  const double dt = 1e-9 * static_cast<double>(now - last);
  last = now;
  const bool answered = shared.plugin->exchange(device, force.data(), dt, &told) == 0;
  now = monotonicNs();
  answer.sound = answered && take(told, now, answer);
  shared.answer.put(answer);
}

void run(const std::shared_ptr<Shared>& shared, std::promise<std::string> opened,
         std::promise<void> ended) {
  void* device = nullptr;
  bool told = false;
  try {
    if (requestRealtime().fifo_error == 0) {
      const sched_param lower{kPriority};
      ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &lower);
    }
    char why[256] = {};
    device = shared->plugin->open(shared->argument.c_str(), why, sizeof why - 1);
    Answer answer;
    answer.sound = false;
    std::int64_t last = monotonicNs();
    for (int i = 0; device && i < 500 && !answer.sound && !shared->stopping; ++i) {
      if (i > 0) shared->wake.waitFor(kPeriod);
      exchangeOnce(*shared, device, true, last, answer);
    }
    why[sizeof why - 1] = 0;
    told = true;
    opened.set_value(device && answer.sound ? ""
                     : device ? "opens and does not answer: is the device switched on?"
                     : *why   ? "cannot be opened: " + std::string(why)
                              : "cannot be opened, and does not say why");
    while (device && !shared->stopping.load()) {
      shared->wake.waitFor(kPeriod);
      exchangeOnce(*shared, device, false, last, answer);
    }
    if (device) {
      exchangeOnce(*shared, device, true, last, answer);
      shared->plugin->close(device);
    }
  } catch (...) { // it broke its word; the device is left as it is
    if (!told) opened.set_value("throws an exception, which no plug-in may");
    shared->answer.put({{}, 0, false, true});
  }
  ended.set_value();
}

class PluginDevice final : public Device {
 public:
  PluginDevice(const patina_device& plugin, std::string name, std::string argument)
      : shared_(std::make_shared<Shared>()) {
    shared_->plugin = &plugin;
    shared_->max_force = described(name, plugin).limits.max_force.value_or(0);
    shared_->name = std::move(name);
    shared_->argument = std::move(argument);
    std::promise<std::string> opened;
    std::promise<void> ended;
    std::future<std::string> cause = opened.get_future();
    ended_ = ended.get_future();
    thread_ = std::thread(run, shared_, std::move(opened), std::move(ended));
    const bool in_time = cause.wait_for(kPatience + kPatience) == std::future_status::ready;
    const std::string why = in_time ? cause.get() : "hangs while it is opened";
    if (why.empty()) return;
    end();
    throw DeviceError("the plug-in " + shared_->name + " " + why);
  }
  ~PluginDevice() override { end(); }

  DeviceState exchange(const Vec3& force, double dt) noexcept override {
    const std::int64_t now = monotonicNs();
    const Answer& answer = shared_->answer.get();
    DeviceState state = answer.state;
    state.age = 1e-9 * static_cast<double>(std::max<std::int64_t>(now - answer.at, 0));
    if (answer.gone)
      state.status = DeviceStatus::gone;
    else if (!answer.sound && state.age > kOldestAge)
      state.status = DeviceStatus::garbled;
    const bool rests = !answer.sound || answer.gone || !(state.age <= kPluginStale) ||
                       !force.allFinite() || !(1e9 * dt <= kOverrun);
    gain_ = rests ? 0 : std::min(1.0, gain_ + dt / kFade);
    Vec3 sent = Vec3::Zero();
    if (gain_ > 0) sent = gain_ * scaledTo(force, shared_->max_force);
    shared_->command.put({sent, now});
    shared_->wake.post();
    return state;
  }

 private:
  void end() noexcept {
    shared_->stopping = true;
    shared_->wake.post();
    if (ended_.wait_for(kPatience) == std::future_status::ready)
      thread_.join();
    else
      thread_.detach();
  }

  const std::shared_ptr<Shared> shared_;
  std::thread thread_;
  std::future<void> ended_;
  double gain_ = 0; // of the force
};

} // namespace

std::unique_ptr<Device> makePluginDevice(const patina_device& plugin, std::string name,
                                         std::string argument) {
  return std::make_unique<PluginDevice>(plugin, std::move(name), std::move(argument));
}

std::unique_ptr<Device> makePluginDevice(std::string_view device) {
  PluginName told = pluginName(device);
  const patina_device& plugin = loadedPlugin(told.name);
  return makePluginDevice(plugin, std::move(told.name), std::move(told.argument));
}

} // namespace patina
