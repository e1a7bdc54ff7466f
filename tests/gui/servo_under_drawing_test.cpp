// Drawing must not starve the servo.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <future>
#include <optional>

#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"
#include "haptics/device/realtime.h"
#include "haptics/servo/latency.h"
#include "haptics/servo/run_delay.h"
#include "support/simulated_device.h"
#include "visualization/values/camera.h"

namespace patina {
namespace {

constexpr double kPeriod = 1000; // [us]
constexpr double kSeconds = 9;
constexpr double kDrawnRadius = 0.03;

// A device that rests in the surface and notes for each tick how long the servo thread waited for a
// processor.
class WatchedDevice final : public Device {
 public:
  struct Tick {
    double wait = 0, exchange = 0; // [us]
  };

  DeviceState exchange(const Vec3& force, double dt) noexcept override {
    const std::int64_t begin = monotonicNs();
    if (!wait_) wait_.emplace(); // the first tick: in the servo's thread
    const std::optional<std::int64_t> total = wait_->total();
    known_ = known_ && total;
    const DeviceState state = rest_->exchange(force, dt);
    if (count_ < ticks_.size())
      ticks_[count_++] = {1e-3 * static_cast<double>(total.value_or(0) - before_),
                          1e-3 * static_cast<double>(monotonicNs() - begin)};
    before_ = total.value_or(0);
    return state;
  }

  // Called once the loop has stopped. Absent if the system does not account for waiting.
  std::optional<std::vector<Tick>> ticks() const {
    if (!known_) return std::nullopt;
    return std::vector<Tick>(ticks_.begin(), ticks_.begin() + static_cast<std::ptrdiff_t>(count_));
  }

 private:
  std::unique_ptr<Device> rest_ = std::make_unique<StillDevice>(Vec3(0.99 * kDrawnRadius, 0, 0));
  std::optional<RunDelay> wait_;
  std::int64_t before_ = 0;
  bool known_ = true;
  std::vector<Tick> ticks_ = std::vector<Tick>(100000);
  std::size_t count_ = 0;
};

std::string shown(const char* name, const Percentiles& us) {
  char text[160];
  std::snprintf(text, sizeof text, "%-42s p50 %.1f, p99 %.1f, p99.9 %.1f, max %.0f us\n", name,
                us.p50, us.p99, us.p999, us.max);
  return text;
}

// Lateness of the servo's wake-ups [us], one entry a tick.
struct Pass {
  bool realtime = false;
  std::vector<double> late;
  // All of them are absent if the system does not account for waiting:
  std::vector<double> taken; // waiting for a processor, plus the previous tick with its device
  Latency bare;              // a loop with nothing to do, meanwhile
  std::string text;
};

Pass passOf(const std::vector<ToolSample>& samples, const WatchedDevice& device,
            const ServoTiming& servo, Latency bare) {
  Pass pass;
  pass.realtime = servo.realtime && bare.realtime;
  const auto ticks = device.ticks();
  for (std::size_t i = 1; i < samples.size(); ++i) { // the first starts the loop
    pass.late.push_back(1e-3 * samples[i].late_ns);
    if (!ticks || i >= ticks->size()) continue;
    const double busy = (*ticks)[i - 1].exchange + 1e-3 * samples[i - 1].step_ns;
    pass.taken.push_back((*ticks)[i].wait + busy);
  }
  pass.text = servo.policy + ", missed " + std::to_string(servo.missed) + "\n" +
              shown("servo late", percentiles(pass.late));
  if (ticks) pass.text += shown("  waiting for a processor and own time", percentiles(pass.taken));
  pass.text += shown("bare loop late", bare.late_us);
  if (bare.wait_us)
    pass.text += shown("  waiting for a processor", *bare.wait_us) +
                 shown("  the timer's or the host's", *bare.timer_us);
  pass.bare = std::move(bare);
  return pass;
}

// The limit is 3 times the idle loop's lateness with the same timer, host and programs; values
// shorter than a twentieth (p99) or a half (p99.9) of the period are always allowed.
double excess(const std::vector<double>& servo, const Percentiles& bare) {
  const Percentiles p = percentiles(servo);
  return std::max(p.p99 / std::max(0.05 * kPeriod, 3 * bare.p99),
                  p.p999 / std::max(0.5 * kPeriod, 3 * bare.p999));
}
double excess(const Pass& pass) {
  double most = excess(pass.late, pass.bare.late_us);
  if (!pass.taken.empty() && pass.bare.wait_us)
    most = std::max(most, excess(pass.taken, *pass.bare.wait_us));
  return most;
}

class ServoUnderDrawing : public WindowTest {
 protected:
  // A second, measured servo uses the window's snapshot while the window draws.
  Pass draw() {
    auto owned = std::make_unique<WatchedDevice>();
    const WatchedDevice& device = *owned;
    ServoLoop loop(std::move(owned));
    loop.publish(edits().scene()->snapshot);
    loop.start();
    auto measuring = std::async(std::launch::async, [] { return measureLatency(kSeconds); });
    std::vector<ToolSample> samples;
    const auto drain = [&] {
      for (ToolSample sample; loop.samples().pop(sample);) samples.push_back(sample);
    };
    double longest = 0, sum = 0;
    int frames = 0;
    while (measuring.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      orbit(*view().view().renderer().GetActiveCamera(), 0.004, 0);
      if (view().frames().refresh()) {
        longest = std::max(longest, frameSeconds());
        sum += frameSeconds();
        ++frames;
      }
      QApplication::processEvents(QEventLoop::AllEvents, 1);
      drain();
    }
    loop.stop();
    drain();
    std::printf("%d frames, mean %.0f ms, longest %.0f ms\n", frames, 1000 * sum / frames,
                1000 * longest);
    EXPECT_EQ(samples.size(), loop.timing().ticks) << "no sample may be lost: ticks are matched";
    EXPECT_GT(samples.size(), 8192U);
    EXPECT_TRUE(!samples.empty() && samples.back().contact);
    return passOf(samples, device, loop.timing(), measuring.get());
  }
};

// The reference is an idle loop of the same priority: timer, virtual machine's host and other
// programs delay both. Without real-time priority every program can delay the servo by chance: the
// test then checks only that no tick is lost.
TEST_F(ServoUnderDrawing, WakesInTimeWhileTheWindowDraws500000Triangles) {
  ASSERT_TRUE(open(saved(icosphere(kDrawnRadius, 158), "sphere.ply"))); // 499,280 triangles
  double least = 1e9;
  for (int round = 0; round < 3 && least > 1; ++round) {
    const Pass pass = draw();
    EXPECT_GT(surfaceShare(), 0.1);
    std::printf("%s", pass.text.c_str());
    if (!pass.realtime) {
      std::printf("no real-time priority here: lateness is shown and not judged\n");
      return;
    }
    least = std::min(least, excess(pass));
    std::printf("%.2f of what is allowed\n", least);
  }
  EXPECT_LE(least, 1);
}

} // namespace
} // namespace patina
