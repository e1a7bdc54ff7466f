// Drawing must not starve the servo.
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <future>

#include "geometry/shapes.h"
#include "gui/window_fixture.h"
#include "haptics/latency.h"
#include "visualization/camera.h"

namespace patina {
namespace {

constexpr double kP99 = 100, kP999 = 500; // [us]
constexpr double kSeconds = 9; // the servo's last 8192 ticks are judged: all under drawing

// A loop as the servo's with nothing to do, on each processor: what this machine itself is late by.
std::vector<Latency> measureProcessors() {
  cpu_set_t allowed;
  sched_getaffinity(0, sizeof allowed, &allowed);
  std::vector<std::future<Latency>> loops;
  for (int processor = 0; processor < CPU_SETSIZE; ++processor)
    if (CPU_ISSET(processor, &allowed))
      loops.push_back(std::async(std::launch::async, [processor] {
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(processor, &one);
        sched_setaffinity(0, sizeof one, &one); // the measuring thread inherits it
        return measureLatency(kSeconds);
      }));
  std::vector<Latency> measured;
  for (auto& loop : loops) measured.push_back(loop.get());
  return measured;
}

std::string shown(const char* name, const Percentiles& us) {
  char text[160];
  std::snprintf(text, sizeof text, "%-28s p50 %.1f, p99 %.1f, p99.9 %.1f, max %.0f us\n", name,
                us.p50, us.p99, us.p999, us.max);
  return text;
}

class ServoUnderDrawing : public WindowTest {
 protected:
  struct Pass {
    ServoTiming servo;
    std::vector<Latency> bare; // meanwhile, one a processor
  };

  Pass draw() {
    auto measuring = std::async(std::launch::async, measureProcessors);
    double longest = 0, sum = 0;
    int frames = 0;
    while (measuring.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      orbit(*view().view().renderer().GetActiveCamera(), 0.004, 0);
      if (view().refresh()) {
        longest = std::max(longest, view().frameSeconds());
        sum += view().frameSeconds();
        ++frames;
      }
      QApplication::processEvents(QEventLoop::AllEvents, 1);
    }
    std::printf("%d frames, mean %.0f ms, longest %.0f ms\n", frames, 1000 * sum / frames,
                1000 * longest);
    return {window_->feel().timing(), measuring.get()};
  }

  static std::string textOf(const Pass& pass) {
    const ServoTiming& servo = pass.servo;
    std::string text =
        servo.policy + ", missed " + std::to_string(servo.missed) + "\n" +
        shown("servo late", {servo.late_p50, servo.late_p99, servo.late_p999, servo.late_max});
    for (const Latency& bare : pass.bare) {
      text += shown("bare loop late", bare.late_us);
      if (!bare.wait_us) continue;
      text += shown("  waiting for a processor", *bare.wait_us);
      text += shown("  the timer's or the host's", *bare.timer_us);
    }
    return text;
  }
};

// What the program and the scheduler are answerable for is the wait for a processor: it is judged
// however busy the machine is, since real-time priority goes first. Lateness also holds what the
// timer, or a virtual machine's host, is late by; a limit that this alone breaks cannot be kept.
TEST_F(ServoUnderDrawing, WakesInTimeWhileTheWindowDraws500000Triangles) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 158), "sphere.ply"))); // 499,280 triangles
  const Pass pass = draw();
  EXPECT_GT(surfaceShare(), 0.1);
  const std::string text = textOf(pass);
  std::printf("%s", text.c_str());
  if (!pass.servo.realtime)
    GTEST_SKIP() << "no real-time priority here: lateness is shown and not judged\n" << text;

  double timer_p99 = 0, timer_p999 = 0;
  for (const Latency& bare : pass.bare) {
    if (!bare.wait_us) continue;
    EXPECT_LE(bare.wait_us->p99, kP99) << text;
    EXPECT_LE(bare.wait_us->p999, kP999) << text;
    timer_p99 = std::max(timer_p99, bare.timer_us->p99);
    timer_p999 = std::max(timer_p999, bare.timer_us->p999);
  }
  const bool late_p99 = pass.servo.late_p99 > kP99;
  const bool late_p999 = pass.servo.late_p999 > kP999;
  EXPECT_FALSE(late_p99 && timer_p99 <= kP99) << text;
  EXPECT_FALSE(late_p999 && timer_p999 <= kP999) << text;
  if (late_p99 || late_p999)
    GTEST_SKIP() << "the timer alone breaks the limit on this machine now: the wait for a "
                    "processor is judged, lateness is shown\n"
                 << text;
}

} // namespace
} // namespace patina
