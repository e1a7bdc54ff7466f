// Cost of painting for the servo and delay of a dab, with a real loop and a real edit thread
// (T-K20).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <thread>

#include "core/percentiles.h"
#include "haptics/device/realtime.h"
#include "haptics/servo/latency.h"
#include "haptics/servo/servo_loop.h"
#include "session/edit_desk.h"
#include "support/least_time.h"
#include "support/simulated_device.h"

namespace patina {
namespace {

using test::Desk;
using test::oneBall;

constexpr double kDepth = 1e-3; // [m], at which the tip rests in the ball of 20 mm
constexpr double kSoonUs = 20;  // [us]: a later wake-up is late
const Vec3 kPlace(0.02, 0, 0);

// Rests in the surface and records the time of each force at the hand.
class ResolvedDevice final : public Device {
 public:
  struct Tick {
    std::int64_t ns;
    double force;
  };
  DeviceState exchange(const Vec3& force, double dt) noexcept override {
    if (count_ < ticks_.size()) ticks_[count_++] = {monotonicNs(), force.norm()};
    return rest_->exchange(force, dt);
  }
  std::vector<Tick> ticks() const { // after the loop has stopped
    return {ticks_.begin(), ticks_.begin() + static_cast<std::ptrdiff_t>(count_)};
  }

 private:
  std::unique_ptr<Device> rest_ = std::make_unique<StillDevice>(kPlace - Vec3(kDepth, 0, 0));
  std::vector<Tick> ticks_ = std::vector<Tick>(60000);
  std::size_t count_ = 0;
};

// Each dab stiffens the surface under the tip: 8 N/m are 8 mN, one tick's fade.
Brush rising() {
  Brush brush = test::stiffBrush(8);
  brush.mode = StrokeMode::add;
  brush.radius = 0.004;
  return brush;
}

struct Pass {
  // One value per dab: time of the edit thread for the hand-over without the dab itself [s], ticks
  // that began from then until the force changed at the hand, and that time [s].
  std::vector<double> work, ticks, felt;
  std::vector<double> step_us, late_us;           // ticks while painting
  std::vector<double> idle_step_us, idle_late_us; // after painting, by the same rule
  bool realtime = false, fault = false;
  std::size_t dropped = 0;
};

// `dabs` dabs, a few milliseconds apart, each in its own stroke with its own force.
Pass paint(int dabs) {
  Progress progress;
  auto owned = std::make_unique<ResolvedDevice>();
  const ResolvedDevice& device = *owned;
  ServoLoop loop(std::move(owned), 1000);
  double work_done = 0;
  std::int64_t published = 0;
  Editor editor(oneBall(100, 20), progress, [&](const EditorNotice& notice) {
    loop.publish(notice.compiled->snapshot);
    work_done = test::threadSeconds();
    published = monotonicNs();
  });
  loop.publish(editor.compiled()->snapshot);
  editor.prepare(Tool::material(MaterialChannel::stiffness), progress);

  std::vector<ToolSample> samples;
  const auto drain = [&] {
    for (ToolSample sample; loop.samples().pop(sample);) samples.push_back(sample);
  };
  const auto pause = [&](int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    drain();
  };
  loop.start();
  pause(1500);
  const std::size_t first = samples.size();
  struct Dab {
    std::int64_t begin, published; // [ns]
    double work;                   // [s]
  };
  std::vector<Dab> times;
  for (int i = 0; i < dabs; ++i) {
    // The same dab alone once more: separates painting from the rest.
    Painter alone(paintSurface(editor.scene(), editor.compiled()->mesh,
                               editor.compiled()->built.field, progress),
                  editor.scene());
    const StrokeSample sample{0, kPlace, 0.5};
    alone.begin(rising());
    const double before = test::threadSeconds();
    (void)alone.dab(sample);
    const double took = test::threadSeconds() - before;
    editor.beginStroke(rising(), progress);
    const std::int64_t begin = monotonicNs();
    const double work_begin = test::threadSeconds();
    (void)editor.dab(sample);
    times.push_back({begin, published, std::max(0.0, work_done - work_begin - took)});
    (void)editor.endStroke();
    pause(6);
  }
  const std::size_t last = samples.size();
  pause(1500);
  Pass pass;
  pass.realtime = loop.timing().realtime;
  pass.dropped = loop.samples().dropped();
  loop.stop();
  drain();
  const auto ticks = device.ticks();
  for (const Dab& dab : times) {
    const auto at = std::find_if(ticks.begin(), ticks.end(),
                                 [&](const auto& tick) { return tick.ns >= dab.begin; });
    if (at == ticks.begin() || at == ticks.end()) continue;
    const double was = (at - 1)->force;
    const auto felt = std::find_if(
        at, ticks.end(), [&](const auto& tick) { return std::abs(tick.force - was) > 1e-3; });
    if (felt == ticks.end()) continue;
    const auto first_after =
        std::find_if(at, ticks.end(), [&](const auto& tick) { return tick.ns >= dab.published; });
    pass.work.push_back(dab.work);
    pass.ticks.push_back(static_cast<double>(std::max<std::ptrdiff_t>(0, felt - first_after)));
    pass.felt.push_back(
        dab.work + 1e-9 * static_cast<double>(std::max<std::int64_t>(0, felt->ns - dab.published)));
  }
  for (std::size_t i = std::max<std::size_t>(200, first); i < samples.size(); ++i) {
    const bool painting = i < last;
    (painting ? pass.step_us : pass.idle_step_us).push_back(1e-3 * samples[i].step_ns);
    (painting ? pass.late_us : pass.idle_late_us).push_back(1e-3 * samples[i].late_ns);
    pass.fault = pass.fault || samples[i].fault;
  }
  return pass;
}

std::string row(const char* name, const std::vector<double>& us) {
  const Percentiles p = percentiles(us);
  char text[160];
  std::snprintf(text, sizeof text, "%-34s p50 %.2f, p99 %.2f, p99.9 %.2f, max %.2f us\n", name,
                p.p50, p.p99, p.p999, p.max);
  return text;
}

// 1.07 measured. Beside two busy loops 2.8 to 3.1: a new snapshot then comes out of another core's
// cache, which takes 3 us; compiling a dab takes 100.
constexpr double kMaxOfIdle = 8;

// The delay is counted in ticks and the cost in processor time; a tick is so short that few are
// interrupted. So no limit depends on other load. A tick is on time under load only with real-time
// priority: lateness is judged there and printed otherwise. p99 is used, because one or two ticks
// in ten belong to a dab.
PATINA_TIMED_TEST(HapticEdit, DabActsWithinTheNextTicksAndDelaysNone) { // T-K20
  double work = 1e9, ticks = 1e9, step = 1e9, late = 1e9;
  bool realtime = false;
  // A disturbed pass is repeated.
  for (int round = 0; round < 3 || (round < 8 && step > kMaxOfIdle); ++round) {
    const Pass pass = paint(250);
    EXPECT_FALSE(pass.fault);
    EXPECT_EQ(pass.dropped, 0u);
    ASSERT_GT(pass.felt.size(), 240u) << "a dab that is not felt";
    const auto us = [](std::vector<double> seconds) {
      for (double& each : seconds) each *= 1e6;
      return seconds;
    };
    std::printf("%s", (row("hand-over of a dab, thread", us(pass.work)) +
                       row("  felt after its dab is done", us(pass.felt)) +
                       row("tick while painting", pass.step_us) +
                       row("  while nothing is painted", pass.idle_step_us) +
                       row("late while painting", pass.late_us) +
                       row("  while nothing is painted", pass.idle_late_us))
                          .c_str());
    realtime = realtime || pass.realtime;
    work = std::min(work, percentiles(pass.work).p50);
    ticks = std::min(ticks, percentiles(pass.ticks).p99);
    step = std::min(step, percentiles(pass.step_us).p99 / percentiles(pass.idle_step_us).p99);
    late = std::min(late, percentiles(pass.late_us).p99 /
                              std::max(kSoonUs, percentiles(pass.idle_late_us).p99));
  }
  std::printf("felt in %g ticks; against ticks while nothing is painted: tick %.2f, late %.2f%s\n",
              ticks, step, late, realtime ? "" : " (no real-time priority here: not judged)");
  test::Reference reference;
  EXPECT_TRUE(test::within("hand-over of a dab, p50, against 1000 ticks", work,
                           test::minSeconds({[&] { reference.ticks(1000); }})[0], 5)); // 2
  EXPECT_LE(ticks, 2);
  EXPECT_LE(step, kMaxOfIdle);
  if (realtime) {
    EXPECT_LE(late, 3);
  }
}

// For the thread sanitizer: painting, values, undo and a servo that reads meanwhile.
TEST(HapticEdit, PaintingWhileTheServoReadsTearsNothing) { // T-K20
  ServoLoop loop(std::make_unique<StillDevice>(kPlace - Vec3(kDepth, 0, 0)), 1000);
  Desk desk({}, [&](const CompiledScene& compiled) { loop.publish(compiled.snapshot); });
  desk.open(oneBall());
  loop.start();
  double least = 1e9, most = 0;
  std::size_t ticks = 0;
  const auto drain = [&] {
    for (ToolSample sample; loop.samples().pop(sample);) {
      ASSERT_TRUE(sample.force.allFinite());
      ASSERT_FALSE(sample.fault);
      if (++ticks < 100 || !sample.contact) continue;
      least = std::min(least, sample.force.norm());
      most = std::max(most, sample.force.norm());
    }
  };
  for (int i = 0; i < 20; ++i) {
    desk.stroke(i % 4 == 3 ? [] { Brush b; b.tool = Tool::relief; b.value = 2e-4; b.radius = 0.005; return b; }() : test::stiffBrush(600 + 20 * i), test::circle(6, -0.1, 0.1));
    if (i % 5 == 4) desk.edits.undo();
    desk.edits.previewValues([i](Scene& scene) { scene.haptics.damping = 0.1 * (i + 1); });
    ASSERT_TRUE(desk.settle());
    drain();
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  drain();
  loop.stop();
  // The force stays between the softest and the stiffest state: no force of half an edit.
  EXPECT_GT(least, 0.9 * 500 * kDepth);
  EXPECT_LT(most, 1000 * (kDepth + 3e-4) * 1.1);
}

} // namespace
} // namespace patina
