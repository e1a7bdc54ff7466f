// A device over libusb fails during contact, painting and recording: the user is notified at once
// and all finished work is kept. The test runs in a process of its own, under usbfs_shim.so.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include <QLabel>
#include <sched.h>

#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "haptics/falcon/emulated_falcon.h"
#include "integration/program.h"
#include "support/emulated_plug.h"
#include "support/places.h"
#include "usb/usb_library.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

namespace fs = std::filesystem;
using Moment = std::chrono::steady_clock::time_point;

constexpr double kSphere = 0.03; // [m]

Moment rightNow() {
  return std::chrono::steady_clock::now();
}
double secondsBetween(Moment begin, Moment end) {
  return std::chrono::duration<double>(end - begin).count();
}

// Notes the time when a label's text has been drawn.
class Drawn : public QObject {
 public:
  explicit Drawn(QLabel& label) : label_(label) { label.installEventFilter(this); }
  bool forceIsBack() const { return label_.text().endsWith(QStringLiteral("Hz")); }
  std::optional<Moment> trouble; // first drawn

 protected:
  bool eventFilter(QObject* object, QEvent* event) override {
    if (event->type() == QEvent::Paint && !forceIsBack() && !trouble) trouble = rightNow();
    return QObject::eventFilter(object, event);
  }

 private:
  QLabel& label_;
};

// A Falcon on the emulated bus, held by a hand that circles over the sphere and presses.
class HapticSphere {
 public:
  explicit HapticSphere(const fs::path& folder) : folder_(folder) {
    bench_.on_frame = [this](double t, const std::array<int, 3>&) {
      // The path is a spiral, so that no lap covers the paint that another one lost.
      if (presses && !(since_ >= 0)) since_ = t;
      const double angle = 2 * t, wide = 0.1 + 0.02 * std::min(t - std::max(since_, 0.0), 60.0);
      const Vec3 out = Vec3(wide * std::cos(angle), wide * std::sin(angle), 1).normalized();
      bench_.rest = presses ? Vec3((kSphere - 3e-3) * out - centre) : Vec3(Vec3::Zero());
      bench_.buttons = presses ? 1 : 0;
      if (const WireFault fault = next_.exchange(WireFault::none); fault != WireFault::none) {
        bench_.faults = {fault, frames_};
        begun_ = rightNow();
        has_begun_ = true;
      }
    };
    attach();
  }
  // Attaches the device with its own timing, even if the machine is busy.
  void attach() {
    sched_param urgent{}, before{};
    const int policy = sched_getscheduler(0);
    sched_getparam(0, &before);
    urgent.sched_priority = 60;
    sched_setscheduler(0, SCHED_FIFO, &urgent);
    plug_.emplace(folder_,
                  EmulatedUsb{.vendor = 0x0403,
                              .product = 0xcb48,
                              .maker = "Novint",
                              .name = "Falcon",
                              .serial = "17",
                              .endpoints = {{0x02}, {0x81}}},
                  [this] { return bench_.plug(); });
    sched_setscheduler(0, policy, &before);
  }
  // Notes the time when the fault becomes visible.
  Moment unplug() {
    plug_.reset();
    return rightNow();
  }
  Moment spoil(WireFault fault, int frames) {
    frames_ = frames;
    has_begun_ = false;
    next_ = fault;
    while (!has_begun_) std::this_thread::yield();
    return begun_;
  }

  std::atomic<bool> presses{false};
  Vec3 centre = Vec3::Zero(); // [m], world: centre of the device's workspace before it presses

 private:
  fs::path folder_;
  double since_ = -1; // [s], time of the first press
  FalconEmulator bench_{{.body = {.mass = 0.25, .damping = 12, .spring = 300, .friction = 0}},
                        systemClock()};
  std::optional<EmulatedUsbDevice> plug_;
  std::atomic<WireFault> next_{WireFault::none};
  std::atomic<bool> has_begun_{false};
  int frames_ = 0;
  Moment begun_;
};

class FalconWindow : public DrivenWindow {
 protected:
  static double distance(const Vec3& place, const Stroke& stroke) {
    double least = (place - stroke.samples.front().position).norm();
    for (std::size_t i = 1; i < stroke.samples.size(); ++i) {
      const Vec3 a = stroke.samples[i - 1].position, way = stroke.samples[i].position - a;
      const double length = way.squaredNorm();
      const double part = length > 0 ? std::clamp((place - a).dot(way) / length, 0.0, 1.0) : 0;
      least = std::min(least, (place - a - part * way).norm());
    }
    return least;
  }
};

TEST_F(FalconWindow, DISABLED_FaultsInAStroke) {
  HapticSphere felt(std::getenv("PATINA_USBFS"));
  Scene scene = sceneOf(icosphere(kSphere, 30), "sphere");
  scene.device = "falcon";
  saveWorkspace(scene, folder_ / "ws");
  ASSERT_TRUE(open(folder_ / "ws"));
  Drawn rate(*find<QLabel>(QStringLiteral("rate")));
  ASSERT_TRUE(waitUntil([&] { return rate.forceIsBack(); }, 5000));
  wait(300);
  felt.centre = feel().sample().tip; // the handle rests in the middle of its workspace
  type(QStringLiteral("d"));         // stiffness
  ASSERT_TRUE(waitUntil([&] { return !edits().thread().busy(); }));
  startLog();
  const std::size_t dropped = feel().servo().dropped();
  felt.presses = true;
  ASSERT_TRUE(waitUntil([&] { return feel().sample().contact; }, 5000));
  wait(700);

  struct Fault {
    const char* name;
    std::function<Moment()> begin;
    bool unplugs = false;
  };
  const auto answers = [&](WireFault kind, int frames) {
    return [&felt, kind, frames] { return felt.spoil(kind, frames); };
  };
  const Fault faults[] = {
      {"unplugged", [&] { return felt.unplug(); }, true},
      {"STALL", answers(WireFault::stall, 2)}, // the first is spent on the answer of its own frame
      {"12 lost", answers(WireFault::mute, 12)},
      {"short", answers(WireFault::shortened, 1)},
      {"corrupt", answers(WireFault::corrupt, 1)},
      {"late", answers(WireFault::late, 1)},
      {"repeated", answers(WireFault::repeated, 1)},
      {"out of order", answers(WireFault::out_of_order, 1)},
      {"noise", answers(WireFault::noise, 1)},
      {"homing lost", answers(WireFault::homing_lost, 1)},
  };
  std::size_t begun = 0;
  constexpr int kTimes = 4; // runs, if another program has the processor
  // An idle machine takes 10 to 60 ms; a picture in progress, composed with the rest of the window,
  // delays the message.
  const double frame = frameSeconds(), limit = std::max(0.1, 0.05 + 3 * frame);
  std::printf("a frame takes %.0f ms\n", 1e3 * frame);
  for (const Fault& fault : faults) {
    double shown = 10, back = 0; // [s]
    for (int time = 0; time < kTimes && (shown > limit || back > 2.3); ++time) {
      do { // a busy machine causes faults of its own
        ASSERT_TRUE(waitUntil([&] { return rate.forceIsBack(); }, 20000)) << fault.name;
        wait(300);
      } while (!rate.forceIsBack());
      rate.trouble.reset();
      const Moment seen = fault.begin();
      ++begun;
      waitUntil([&] { return rate.trouble.has_value(); }, 2000);
      shown = rate.trouble ? secondsBetween(seen, *rate.trouble) : 10;
      std::printf("%s: shown after %.0f ms\n", fault.name, 1e3 * shown);
      if (!fault.unplugs) continue;
      wait(300);
      felt.attach();
      const Moment attached = rightNow();
      ASSERT_TRUE(waitUntil([&] { return rate.forceIsBack(); }, 10000)) << fault.name;
      back = secondsBetween(attached, rightNow());
    }
    EXPECT_LE(shown, limit) << fault.name;
    EXPECT_LE(back, 2.3) << "two seconds and the ramp";
  }
  ASSERT_TRUE(waitUntil([&] { return rate.forceIsBack(); }, 20000));
  wait(500);
  felt.presses = false;
  ASSERT_TRUE(waitUntil([&] { return !feel().sample().contact; }, 5000));
  wait(300);
  ASSERT_TRUE(waitUntil([&] { return !edits().thread().busy(); }));

  // Every tick in contact while the button was down is in a stroke of the journal.
  saving().saveTo(QString::fromStdString((folder_ / "kept").string()));
  const OpenedWorkspace kept = openWorkspace(folder_ / "kept");
  std::vector<Stroke> strokes;
  for (const JournalEvent& event : kept.journal)
    if (const auto* stroke = std::get_if<Stroke>(&event)) strokes.push_back(*stroke);
  ASSERT_FALSE(strokes.empty());
  const auto ticks = logged();
  EXPECT_EQ(feel().servo().dropped(), dropped);
  std::size_t painted = 0, gaps = 0;
  double off = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (i > 0) {
      ASSERT_GT(ticks[i].t, ticks[i - 1].t) << i;
      gaps += ticks[i].t - ticks[i - 1].t > 0.05;
    }
    if (!ticks[i].contact || (ticks[i].buttons & 1) == 0) continue;
    ++painted;
    double least = 1;
    for (const Stroke& stroke : strokes)
      least = std::min(least, distance(ticks[i].surface, stroke));
    off = std::max(off, least);
  }
  std::printf("%zu ticks of contact in %zu strokes, off by %.3f mm of a radius of %.1f mm\n",
              painted, strokes.size(), 1e3 * off, 1e3 * strokes.front().brush.radius);
  EXPECT_GT(painted, 4000u);
  EXPECT_LT(off, 0.02 * strokes.front().brush.radius);
  EXPECT_LE(gaps, begun);
}

TEST(FalconInAStroke, ShowsEachFaultWithinATenthOfASecondAndLosesNothing) {
  std::string cause;
  if (!usbLibrary(cause)) GTEST_SKIP() << cause;
  const test::ScratchFolder bus;
  const test::Environment environment{
      {{"LD_PRELOAD", test::preloadable("usbfs_shim.so")}, {"PATINA_USBFS", bus.path().string()}}};
  const test::Outcome outcome =
      test::Running({"--gtest_filter=FalconWindow.DISABLED_FaultsInAStroke",
                     "--gtest_also_run_disabled_tests"},
                    fs::read_symlink("/proc/self/exe"))
          .wait();
  EXPECT_EQ(outcome.exit, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("1 test from 1 test suite ran"), std::string::npos) << outcome.out;
  std::fputs(outcome.out.substr(0, outcome.out.find("[  ")).c_str(), stdout);
}

} // namespace
} // namespace patina
