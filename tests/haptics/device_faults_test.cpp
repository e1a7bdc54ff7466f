// All faults between servo and motors, free, in contact and in a stroke: the force at the wire, in
// simulated time.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "haptics/falcon_support.h"
#include "haptics/law/plane.h"
#include "haptics/servo/cross_fade.h"
#include "support/constants.h"
#include "support/longer.h"

namespace patina::test {
namespace {

enum class Situation { free, contact, stroke };
const char* name(Situation situation) {
  return situation == Situation::free      ? "free"
         : situation == Situation::contact ? "contact"
                                           : "stroke";
}

// The servo's loop like that of ServoLoop, on the plane z = 0 and an emulated Falcon.
class HapticFalcon {
 public:
  explicit HapticFalcon(Situation situation, const FalconEmulatorSpec& spec = bench())
      : rig(spec), situation_(situation), snapshot_(plane()) {
    law_.fadeTo(snapshot_.get());
  }
  static FalconEmulatorSpec bench() {
    return {.body = {.mass = 0.25, .damping = 12, .spring = 300, .friction = 0}};
  }

  static std::shared_ptr<const HapticSnapshot> plane() {
    HapticProperties haptics;
    haptics.stiffness = 600;
    return planeSnapshot(haptics, {});
  }

  struct Broken {
    bool servo = false, window = false;
    std::optional<Vec3> command{};
  } broken;

  void tick() {
    const double t = rig.clock->now();
    const double depth = situation_ == Situation::free ? 0.01 : -0.012;
    const double along = situation_ == Situation::stroke ? 0.02 * std::sin(2 * t) : 0;
    rig.bench.rest = Vec3(along, 0, depth);
    if (!broken.window) rig.notes->heartbeat_at = t;
    const DeviceState& state = rig.tick(broken.command.value_or(force_), !broken.servo);
    if (broken.servo) return;
    status = effectiveStatus(state);
    if (status != DeviceStatus::ok) {
      EXPECT_TRUE(holds(status)) << text(status);
      force_.setZero();
      return law_.resetContact();
    }
    const Contact contact = law_.tick(state.position, kPeriod);
    force_ = contact.force;
    ++felt;
    // A rendered state was measured just now, or its age is reported.
    EXPECT_LT((state.position - rig.bench.handle()).norm(), 1e-3 + 0.5 * (state.age + 2e-3));
  }
  void run(double seconds) {
    for (const double until = rig.clock->now() + seconds; rig.clock->now() < until;) tick();
  }
  bool runUntilFelt(double seconds) {
    for (const double until = rig.clock->now() + seconds; rig.clock->now() < until;) {
      tick();
      if (rig.notes->gain >= 1) return true;
    }
    return false;
  }

  FalconRig rig;
  DeviceStatus status = DeviceStatus::reconnecting;
  std::uint64_t felt = 0; // ticks

 private:
  Situation situation_;
  std::shared_ptr<const HapticSnapshot> snapshot_;
  CrossFade law_;
  Vec3 force_ = Vec3::Zero();
};

struct Fault {
  const char* name;
  std::function<void(HapticFalcon&)> begin;
  std::function<void(HapticFalcon&)> end;
  double visible = 0; // [s] latest delay after the tick in which it begins
  double lasts = 0.05;
  bool resumes = true;
  bool passes = true; // frames still get through while it lasts
};

Fault ofAnswers(const char* name, WireFault kind, double visible, int frames = 1) {
  return {name,
          [=](HapticFalcon& f) {
            f.rig.bench.faults = {kind, frames};
          },
          [](HapticFalcon&) {}, visible};
}

std::vector<Fault> faults() {
  constexpr double kWire = 0.3e-3, kOverdue = 2.3e-3; // time of an answer; time of a missing one
  const auto nothing = [](HapticFalcon&) {};
  std::vector<Fault> list{
      ofAnswers("STALL", WireFault::stall, kWire),
      ofAnswers("lost", WireFault::mute, kOverdue),
      ofAnswers("short", WireFault::shortened, kOverdue),
      ofAnswers("corrupt", WireFault::corrupt, kWire),
      ofAnswers("a bit flipped", WireFault::flipped, kWire),
      ofAnswers("late", WireFault::late, kOverdue),
      ofAnswers("repeated", WireFault::repeated, kWire),
      ofAnswers("of the frame before", WireFault::stale, kWire),
      ofAnswers("out of order", WireFault::out_of_order, kOverdue),
      ofAnswers("noise", WireFault::noise, kOverdue),
      ofAnswers("homing lost", WireFault::homing_lost, kWire),
      ofAnswers("12 lost", WireFault::mute, kOverdue, 12),
      ofAnswers("12 of noise", WireFault::noise, kOverdue, 12),
      ofAnswers("12 stalls", WireFault::stall, kWire, 12),
  };
  list.back().passes = false;
  list.push_back({"unplugged", [](HapticFalcon& f) { f.rig.bench.unplug(); },
                  [](HapticFalcon& f) { f.rig.bench.attach(); }, 0, 0.3, true, false});
  list.push_back({"servo stops", [](HapticFalcon& f) { f.broken.servo = true; },
                  [](HapticFalcon& f) { f.broken.servo = false; }, 3e-3});
  list.push_back({"window hangs", [](HapticFalcon& f) { f.broken.window = true; },
                  [](HapticFalcon& f) { f.broken.window = false; }, 0.5, 10});
  list.push_back({"NaN asked for", [](HapticFalcon& f) { f.broken.command = Vec3(0, kNan, 0); },
                  [](HapticFalcon& f) { f.broken.command.reset(); }});
  list.push_back({"infinity asked for",
                  [](HapticFalcon& f) { f.broken.command = Vec3(HUGE_VAL, 0, 0); },
                  [](HapticFalcon& f) { f.broken.command.reset(); }});
  list.push_back({"firmware lost and refused", [](HapticFalcon& f) { f.rig.bench.loseFirmware(); },
                  nothing, kOverdue, 3, false, false});
  return list;
}

// Checks the wire from the moment when the fault is visible: no force 5 ms later, until it is over.
TEST(DeviceFaults, RemoveTheForceWithinFiveMillisecondsAndRestoreItByTheRamp) {
  double worst = 0;
  const std::vector<Fault> all = faults();
  EXPECT_GE(all.size(), 15U);
  for (const Fault& fault : all)
    for (const Situation situation : {Situation::free, Situation::contact, Situation::stroke}) {
      SCOPED_TRACE(std::string(fault.name) + ", " + name(situation));
      HapticFalcon f(situation);
      ASSERT_TRUE(f.runUntilFelt(1));
      f.run(0.7);
      const bool pushes = situation != Situation::free;
      ASSERT_EQ(f.rig.sent.back().force(), pushes);
      const std::uint64_t haptic_before = f.felt;
      const std::uint64_t faults_before = f.rig.notes->faults;

      const std::size_t from = f.rig.sent.size();
      fault.begin(f);
      f.tick(); // visible from the end of this tick's frame on
      const double seen = f.rig.sent.size() > from ? f.rig.sent[from].t : f.rig.clock->now();
      const double visible = seen + fault.visible;
      bool shown = false;
      for (const double until = f.rig.clock->now() + fault.lasts; f.rig.clock->now() < until;) {
        f.tick();
        if (f.rig.clock->now() < visible + 0.1)
          shown = shown || f.rig.notes->inhibit != ForceInhibit::none || f.rig.notes->gain < 1 ||
                  f.rig.notes->status != DeviceStatus::ok;
      }
      EXPECT_TRUE(shown) << "no listener is notified";
      fault.end(f);
      const double ended = f.rig.clock->now();

      double last_force = -1, first_none = -1;
      std::size_t i = from;
      for (; i < f.rig.sent.size() && first_none < 0; ++i) {
        if (f.rig.sent[i].force())
          last_force = f.rig.sent[i].t;
        else if (f.rig.sent[i].t > seen || !pushes || fault.visible == 0)
          first_none = f.rig.sent[i].t;
      }
      if (pushes && last_force > 0) {
        worst = std::max(worst, last_force - visible);
        EXPECT_LE(last_force, visible + 5e-3);
      }
      // The device keeps the last force that it received: silence answers a fault only if nothing
      // gets through.
      if (fault.passes) {
        ASSERT_GT(first_none, 0) << "no frame without force";
        EXPECT_LE(first_none, visible + 5e-3);
      }

      if (!fault.resumes) {
        EXPECT_NE(f.rig.notes->cause(), "");
        for (; i < f.rig.sent.size(); ++i) ASSERT_FALSE(f.rig.sent[i].force());
        continue;
      }
      ASSERT_TRUE(f.runUntilFelt(2.3)) << f.rig.notes->cause();
      EXPECT_LE(f.rig.clock->now() - ended, 2.25);
      // The force needs the time of the ramp from the last frame without force to its full value.
      EXPECT_GE(f.rig.clock->now() - first_none, 0.25);
      f.run(0.3);
      EXPECT_EQ(f.rig.sent.back().force(), pushes);
      EXPECT_GT(f.felt, haptic_before + 200); // the stroke goes on
      EXPECT_GE(f.rig.notes->faults.load(), faults_before);
    }
  std::printf("%zu faults in 3 situations: at most %.2f ms of force after it can be seen\n",
              all.size(), 1e3 * std::max(worst, 0.0));
}

TEST(DeviceFaults, HungEditsDoNotReachTheHand) {
  // The servo keeps the last snapshot; no thread publishes for ten seconds.
  HapticFalcon f(Situation::contact);
  ASSERT_TRUE(f.runUntilFelt(1));
  f.run(0.5);
  const std::uint64_t before = f.felt;
  const std::size_t from = f.rig.sent.size();
  f.run(10);
  EXPECT_GE(f.felt - before, 9990U);
  for (std::size_t i = from; i < f.rig.sent.size(); ++i) ASSERT_TRUE(f.rig.sent[i].force());
}

TEST(DeviceFaults, EndWithinTwoSecondsAfterEachOfAHundredUnpluggings) {
  HapticFalcon f(Situation::contact);
  ASSERT_TRUE(f.runUntilFelt(1));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> away(0.01, 1.5);
  double longest = 0, shortest_ramp = 1;
  for (int time = 0; time < 100; ++time) {
    f.run(0.05);
    f.rig.bench.unplug();
    f.run(away(random));
    ASSERT_NE(f.status, DeviceStatus::ok);
    const std::size_t from = f.rig.sent.size();
    const double plugged = f.rig.clock->now();
    f.rig.bench.attach();
    ASSERT_TRUE(f.runUntilFelt(3)) << time;
    const double whole = f.rig.clock->now();
    const auto first = std::find_if(f.rig.sent.begin() + static_cast<std::ptrdiff_t>(from),
                                    f.rig.sent.end(), [](const SentFrame& s) { return s.force(); });
    ASSERT_NE(first, f.rig.sent.end());
    longest = std::max(longest, first->t - plugged);
    shortest_ramp = std::min(shortest_ramp, whole - first->t);
  }
  EXPECT_LE(longest, 2);
  EXPECT_GE(shortest_ramp, 0.249); // 250 exchanges, the first of which already sends a force
  EXPECT_EQ(f.rig.notes->connect_count, 101U);
  std::printf("resumed in %.2f s at most, ramp %.3f s at least\n", longest, shortest_ramp);
}

// A surplus answer that no read awaits is detected, and is not taken for the newest for long.
TEST(DeviceFaults, NeverRenderAnOldPositionInTwentySecondsOfFaults) {
  HapticFalcon f(Situation::stroke);
  ASSERT_TRUE(f.runUntilFelt(1));
  std::mt19937 random(12);
  const long ticks = longer(20000);
  constexpr WireFault kKinds[] = {WireFault::mute,    WireFault::shortened,   WireFault::corrupt,
                                  WireFault::flipped, WireFault::late,        WireFault::repeated,
                                  WireFault::stale,   WireFault::out_of_order};
  std::uint64_t injected = 0;
  for (long i = 0; i < ticks; ++i) {
    if (random() % 100 == 0) {
      f.rig.bench.faults = {kKinds[random() % std::size(kKinds)], 1};
      ++injected;
    }
    f.tick(); // it compares each position with the handle's
  }
  EXPECT_GE(f.rig.notes->faults.load(), injected);
  EXPECT_EQ(f.rig.notes->connect_count, 1U) << "a lost frame must not restart the connection";
}

} // namespace
} // namespace patina::test
