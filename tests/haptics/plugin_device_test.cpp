// Plug-in devices: libraries that load or are refused, and no fault of a plug-in leaves a force
// behind or stops the loop.
#include "haptics/plugin/plugin_device.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <pthread.h>
#include <random>
#include <thread>

#include "core/error.h"
#include "core/file.h"
#include "haptics/catalog/device_catalog.h"
#include "haptics/device/realtime.h"
#include "haptics/faulty_plugin.h"
#include "haptics/plugin/plugin_abi.h"
#include "haptics/plugin/plugin_library.h"
#include "support/constants.h"
#include "support/fresh_folder.h"
#include "support/places.h"

namespace patina {
namespace {

using test::Fault;
using test::faulty;
using test::kFaulty;
using test::kNan;
using test::kPeriod;
using test::makeFaulty;
using test::Noted;

template <class Work> std::string causeOf(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

// Gives the test's own thread a servo's priority and takes it back: its children would inherit it,
// and a spinning one would block all others on one processor.
struct Realtime {
  Realtime() { requestRealtime(); }
  ~Realtime() {
    const sched_param usual{};
    ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &usual);
  }
  Realtime(const Realtime&) = delete;
  Realtime& operator=(const Realtime&) = delete;
};

// Exchanges like a servo, with a law that computes the force from the state.
struct Loop {
  Realtime realtime;
  std::unique_ptr<Device> device = makeFaulty("", std::make_shared<LinkStatistics>());
  double stiffness = 0, friction = 0; // free, in contact, in a stroke
  DeviceState state;
  Vec3 force = Vec3::Zero();
  double max_age = 0; // largest age of a state that counted [s]

  void tick(int count) {
    for (int i = 0; i < count; ++i) {
      std::this_thread::sleep_for(std::chrono::microseconds(900));
      state = device->exchange(force, kPeriod);
      const bool felt = effectiveStatus(state) == DeviceStatus::ok;
      force = felt ? Vec3(friction, 0, stiffness * state.position.z()) : Vec3(Vec3::Zero());
      if (felt) max_age = std::max(max_age, state.age);
    }
  }
  // Returns whether the force fades in, however busy the machine is: a late tick restarts the fade.
  bool settles() {
    const double full = std::hypot(friction, stiffness * 3e-3);
    for (int i = 0; i < 60; ++i) {
      tick(100);
      const int last = std::min(faulty.calls.load(), 20000) - 1;
      if (effectiveStatus(state) == DeviceStatus::ok && last >= 0 &&
          std::abs(faulty.noted[static_cast<std::size_t>(last)].force - full) < 1e-9)
        return true;
    }
    return false;
  }
};

std::size_t firstWith(Fault fault) {
  const auto end = faulty.noted.begin() + std::min(faulty.calls.load(), 20000);
  return static_cast<std::size_t>(
      std::find_if(faulty.noted.begin(), end, [&](const Noted& n) { return n.fault == fault; }) -
      faulty.noted.begin());
}

const std::pair<double, double> kLaws[] = {{0, 0}, {400, 0}, {400, 0.3}};

class PluginLibraries : public testing::Test {
 protected:
  PluginLibraries() {
    folder_ = test::trustedFolder("plugins");
    ::setenv("PATINA_DEVICES", folder_.c_str(), 1);
  }
  ~PluginLibraries() override {
    ::unsetenv("PATINA_DEVICES");
    std::filesystem::remove_all(folder_);
  }
  std::string causeOfLoading(const char* name) {
    return causeOf([&] { (void)loadedPlugin(name); });
  }
  // Copies a built library to where it is found first.
  void put(const char* from, const char* name) {
    std::filesystem::copy_file(test::programFolder() / from,
                               folder_ / ("patina_device_" + std::string(name) + ".so"));
  }
  std::filesystem::path folder_;
};

TEST_F(PluginLibraries, CarryForceAndStateOfTheExample) {
  put("patina_device_example.so", "example");
  const Realtime realtime;
  const auto device = makePluginDevice("plugin:example:0.01,0.02,0.03");
  DeviceState state;
  const auto until = [&](const Vec3& force, const auto& done) {
    for (int i = 0; i < 10000; ++i) {
      std::this_thread::sleep_for(std::chrono::microseconds(900));
      state = device->exchange(force, kPeriod);
      if (effectiveStatus(state) == DeviceStatus::ok && done()) return true;
    }
    return false;
  };
  ASSERT_TRUE(until(Vec3::Zero(), [] { return true; }));
  EXPECT_LT((state.position - Vec3(0.01, 0.02, 0.03)).norm(), 1e-9);
  // The tip rests where its spring balances the force; a busy machine may restart the fade.
  const Vec3 rest(0.01, 0.02 + 0.3 / 150, 0.03);
  EXPECT_TRUE(until(Vec3(0, 0.3, 0), [&] {
    return (state.position - rest).norm() < 1e-5 && state.velocity && state.velocity->norm() < 1e-4;
  })) << state.position.transpose();
}

TEST(PluginDevice, SendsNoForceAfterAFaultAndReportsItToTheLoop) {
  for (const Fault fault : {Fault::answers_nan, Fault::answers_infinity, Fault::leaves_it_out,
                            Fault::refuses, Fault::turns_wrongly, Fault::is_far, Fault::odd_status,
                            Fault::negative_age, Fault::old_age, Fault::is_gone, Fault::throws}) {
    for (const auto& [stiffness, friction] : kLaws) {
      Loop loop;
      loop.stiffness = stiffness;
      loop.friction = friction;
      ASSERT_TRUE(loop.settles());
      faulty.fault = fault;
      loop.tick(60);
      const int id = static_cast<int>(fault);
      EXPECT_NE(effectiveStatus(loop.state), DeviceStatus::ok) << id;
      EXPECT_LE(loop.max_age, kMaxStateAge) << id;
      const std::size_t first = firstWith(fault);
      ASSERT_LT(first, static_cast<std::size_t>(faulty.calls)) << id;
      const std::size_t until = first + 1;
      for (std::size_t i = until; i < static_cast<std::size_t>(faulty.calls); ++i)
        ASSERT_EQ(faulty.noted[i].force, 0) << id << ", exchange " << i - first;
      EXPECT_EQ(faulty.left, 0) << id << ": closed with a force on it";
      faulty.fault = Fault::none;
    }
  }
}

TEST(PluginDevice, ReportsCalibrationAndGetsNoForce) {
  Loop loop;
  loop.stiffness = 400;
  ASSERT_TRUE(loop.settles());
  faulty.fault = Fault::calibrates;
  loop.tick(60);
  EXPECT_EQ(effectiveStatus(loop.state), DeviceStatus::calibrating);
  const std::size_t first = firstWith(Fault::calibrates);
  ASSERT_LT(first + 1, static_cast<std::size_t>(faulty.calls));
  for (std::size_t i = first + 1; i < static_cast<std::size_t>(faulty.calls); ++i)
    ASSERT_EQ(faulty.noted[i].force, 0) << i - first;
  faulty.fault = Fault::none;
  EXPECT_TRUE(loop.settles());
}

TEST(PluginDevice, StallRaisesTheAgeAndThenTheForceFadesIn) {
  for (const auto& [stiffness, friction] : kLaws) {
    Loop loop;
    loop.stiffness = stiffness;
    loop.friction = friction;
    ASSERT_TRUE(loop.settles());
    faulty.fault = Fault::stalls;
    const auto begin = monotonicNs();
    loop.tick(40);
    const double passed = 1e-9 * static_cast<double>(monotonicNs() - begin);
    EXPECT_GT(passed, 0.03);
    EXPECT_EQ(effectiveStatus(loop.state), DeviceStatus::reconnecting); // the ticks went on
    loop.tick(100);
    ASSERT_TRUE(loop.settles());
    EXPECT_EQ(effectiveStatus(loop.state), DeviceStatus::ok);
    const std::size_t after = firstWith(Fault::stalls) + 1;
    ASSERT_LT(after + 100, static_cast<std::size_t>(faulty.calls));
    EXPECT_EQ(faulty.noted[after].force, 0) << "the exchange after the stall";
    const double full = std::hypot(friction, stiffness * 3e-3);
    for (std::size_t i = after; i < static_cast<std::size_t>(faulty.calls); ++i) {
      const double since = 1e-9 * static_cast<double>(faulty.noted[i].at - faulty.noted[after].at);
      // The ticks' dt is a millisecond, and they take at least 900 us.
      ASSERT_LE(faulty.noted[i].force, full * (since + 5e-3) / 0.9 / 0.25 + 1e-12);
    }
  }
}

TEST(PluginDevice, GetsAlmostNoForceIfAlwaysLate) {
  Loop loop;
  loop.stiffness = 400;
  faulty.fault = Fault::slow; // 8 ms, and 4 are too old
  loop.tick(300);
  double most = 0;
  for (int i = 0; i < faulty.calls; ++i)
    most = std::max(most, faulty.noted[static_cast<std::size_t>(i)].force);
  // Only a tick just after an answer may pass a state on, and its force has not faded in.
  EXPECT_LT(most, 0.1);
  faulty.fault = Fault::none;
}

TEST(PluginDevice, KeepsNoForceIfTheServoHangs) {
  Loop loop;
  loop.stiffness = 400;
  loop.tick(400);
  const auto last = monotonicNs();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  int late = 0, rests = 0;
  for (int i = 0; i < faulty.calls; ++i) {
    const Noted& noted = faulty.noted[static_cast<std::size_t>(i)];
    if (noted.at < last + 5'000'000) continue;
    ++rests;
    late += noted.force > 0;
  }
  EXPECT_GE(rests, 10); // the plug-in is still served
  EXPECT_LE(late, 1);   // one may have been in progress
}

TEST(PluginDevice, LimitsForcesAndSendsNoInvalidOnes) {
  Loop loop;
  for (const double huge : {1e6, 1e300, kNan, double(INFINITY), -1e9}) {
    for (int i = 0; i < 1500; ++i) {
      std::this_thread::sleep_for(std::chrono::microseconds(300));
      loop.device->exchange(Vec3(huge, 0, huge), kPeriod);
    }
  }
  double most = 0;
  for (int i = 0; i < faulty.calls; ++i) {
    ASSERT_TRUE(std::isfinite(faulty.noted[static_cast<std::size_t>(i)].force));
    most = std::max(most, faulty.noted[static_cast<std::size_t>(i)].force);
  }
  EXPECT_LE(most, 3 * (1 + 1e-12));
  EXPECT_GT(most, 2.9);
}

TEST(PluginDevice, EndsWithAForceOfZeroAndAtMostASecondAfterAHang) {
  {
    Loop loop;
    loop.stiffness = 400;
    loop.tick(300);
  }
  EXPECT_EQ(faulty.closed, 1);
  EXPECT_EQ(faulty.noted[static_cast<std::size_t>(faulty.calls - 1)].force, 0);
}

TEST(PluginDevice, IsAbandonedIfItNeverReturns) {
  auto loop = std::make_unique<Loop>();
  loop->tick(20);
  faulty.fault = Fault::hangs;
  loop->tick(20);
  const auto begin = monotonicNs();
  loop.reset();
  EXPECT_LT(1e-9 * static_cast<double>(monotonicNs() - begin), 5);
  EXPECT_EQ(faulty.closed, 0);
  faulty.release = true; // its thread ends by itself
  for (int i = 0; i < 5000 && faulty.closed == 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(faulty.closed, 1);
}

TEST(PluginDevice, GivesTheCauseIfItCannotOpen) {
  const auto opening = [](const char* argument) {
    const auto notes = std::make_shared<LinkStatistics>();
    const auto device = makeFaulty(argument, notes);
    for (int i = 0; i < 5000 && notes->cause().empty(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(effectiveStatus(device->exchange(Vec3::Zero(), kPeriod)), DeviceStatus::reconnecting);
    return notes->cause();
  };
  EXPECT_TRUE(has(opening("refuse"), "the plug-in cannot be opened: xxxx"));
  EXPECT_EQ(opening("throw"), "the plug-in threw an exception: it must return an error instead");
}

TEST(PluginDevice, ValidatesItsDescription) {
  const PluginFound found = described("faulty", kFaulty);
  EXPECT_EQ(found.caption, std::string(64, 'N'));
  EXPECT_EQ(found.limits.max_force, 3);
  EXPECT_FALSE(found.limits.max_stiffness);
  EXPECT_FALSE(found.limits.workspace);
}

TEST(PluginDevice, UsesItsReportedWorkspace) {
  patina_device sound = kFaulty;
  sound.describe = [](patina_device_description* told) {
    for (int axis = 0; axis < 3; ++axis) {
      told->workspace_low[axis] = -0.01 * (axis + 1);
      told->workspace_high[axis] = 0.02 * (axis + 1);
    }
    told->max_stiffness = 1500;
  };
  const DeviceLimits limits = described("sound", sound).limits;
  ASSERT_TRUE(limits.workspace);
  EXPECT_EQ(limits.workspace->min(), Vec3(-0.01, -0.02, -0.03));
  EXPECT_EQ(limits.workspace->max(), Vec3(0.02, 0.04, 0.06));
  EXPECT_EQ(limits.max_stiffness, 1500);
  ASSERT_TRUE(guardFor(limits).workspace);
  EXPECT_EQ(guardFor(limits).workspace->max(), Vec3(0.02, 0.04, 0.06));
}

TEST_F(PluginLibraries, AreRefusedInOneLineIfTheVersionDiffers) {
  put("patina_device_example.so", "example");
  put("odd_plugin_1.so", "later");
  put("odd_plugin_2.so", "hollow");
  put("odd_plugin_3.so", "nothing");
  put("fault_shim.so", "foreign");
  std::ofstream(folder_ / "patina_device_text.so") << "no library";
  EXPECT_TRUE(has(causeOfLoading("later"), "patina_device_later.so is made for version 2 of "
                                           "patina_device.h, this program reads version 1: build"));
  EXPECT_TRUE(has(causeOfLoading("hollow"), "is incomplete"));
  EXPECT_TRUE(has(causeOfLoading("nothing"), "has no device to offer"));
  EXPECT_TRUE(has(causeOfLoading("foreign"), "is no plug-in: it has no patina_device_entry_v1"));
  EXPECT_TRUE(has(causeOfLoading("text"), "cannot be loaded: it is no shared library"));
  EXPECT_TRUE(has(causeOfLoading("absent"), "there is no plug-in absent: put "
                                            "patina_device_absent.so into one of "));
  for (const char* name : {"later", "hollow", "nothing", "foreign", "text", "absent"})
    EXPECT_FALSE(has(causeOfLoading(name), "\n")) << name;
  // The list has all of them, and the example.
  int sound = 0, odd = 0;
  for (const PluginFound& found : installedPlugins()) ++(found.problem.empty() ? sound : odd);
  EXPECT_EQ(sound, 1);
  EXPECT_EQ(odd, 5);
}

TEST_F(PluginLibraries, AreRefusedInOneLineIfOthersCanChangeThem) {
  put("patina_device_example.so", "shared");
  const std::filesystem::path file = folder_ / "patina_device_shared.so";
  const auto setWritable = [](const std::filesystem::path& path, bool by_all) {
    std::filesystem::permissions(path, std::filesystem::perms::others_write,
                                 by_all ? std::filesystem::perm_options::add
                                        : std::filesystem::perm_options::remove);
  };
  for (const std::filesystem::path& place : {file, folder_}) {
    EXPECT_EQ(causeOfLoading("shared"), "nothing");
    setWritable(place, true);
    EXPECT_TRUE(has(causeOfLoading("shared"), "patina_device_shared.so: is not trusted: others may "
                                              "write into "));
    EXPECT_FALSE(has(causeOfLoading("shared"), "\n"));
    setWritable(place, false);
  }
  EXPECT_EQ(causeOfLoading("shared"), "nothing");
}

// The file is read before it is known to be sound: damaged tables end in one line or in nothing.
TEST_F(PluginLibraries, DamagedFilesAreReadWithinTheirBytes) {
  const std::string sound = readFile(test::programFolder() / "patina_device_example.so");
  const std::filesystem::path file = folder_ / "damaged.so";
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string bytes = sound;
    for (int k = 0; k < 4; ++k) { // in the header, the table of sections or a table of symbols
      const std::size_t from = k == 0 ? 0 : k == 1 ? bytes.size() - 2000 : bytes.size() / 32;
      bytes[from + random() % (k == 0   ? 64
                               : k == 1 ? 2000
                                        : 2048)] = static_cast<char>(random() % 256);
    }
    if (i % 3 == 0) bytes.resize(random() % bytes.size());
    std::ofstream(file, std::ios::binary) << bytes;
    refused += causeOf([&] { requirePluginAbi(file); }) != "nothing";
  }
  EXPECT_GT(refused, 100);
}

TEST_F(PluginLibraries, AreNamedByAWordAndNeverByAPath) {
  for (const char* name : {"plugin:", "plugin:../evil", "plugin:a/b", "plugin:a.so", "plugin::x"})
    EXPECT_TRUE(has(causeOf([&] { (void)deviceNamed(name); }), "it must be plugin:NAME")) << name;
  EXPECT_EQ(pluginName("plugin:inverse3:localhost:10001").argument, "localhost:10001");
  EXPECT_EQ(std::string(deviceNamed("plugin:example").name), "plugin");
}

} // namespace
} // namespace patina
