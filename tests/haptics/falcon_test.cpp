// The Falcon's frames, bring-up and firmware, against the emulated device.
#include "haptics/falcon/falcon_device.h"

#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "core/error.h"
#include "core/sha256.h"
#include "haptics/falcon/falcon_frame.h"
#include "haptics/falcon_support.h"
#include "support/fresh_folder.h"
#include "support/longer.h"

namespace patina::test {
namespace {

namespace fs = std::filesystem;

FalconBytes textual(const char* text) {
  FalconBytes bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(text[i]);
  return bytes;
}

TEST(FalconFrame, MatchesTheWireFormat) {
  // 0x1234, -1 and 0, little end first; green and homing; by hand.
  const FalconCommand command{{0x1234, -1, 0}, FalconLights::kGreen, 0x01};
  EXPECT_EQ(encoded(command), textual("<EDCBPPPPAAAADA>"));
}

TEST(FalconFrame, EveryEncoderValueButtonAndAxisIsReadBack) {
  for (int value = -32768; value <= 32767; ++value) {
    FalconBytes bytes = encoded({{static_cast<std::int16_t>(value), 0, 7}, 0, 0});
    const int info = (value & 15) | (value >> 4 & 7) << 4;
    bytes[13] = static_cast<std::byte>('A' + info);
    const auto answer = decoded(bytes);
    ASSERT_TRUE(answer.has_value());
    ASSERT_EQ(answer->encoders[0], value);
    ASSERT_EQ(answer->encoders[2], 7);
    ASSERT_EQ(answer->buttons, value & 15);
    ASSERT_EQ(answer->homed, value >> 4 & 7);
  }
}

TEST(FalconFrame, DetectsOneInvalidByte) {
  const FalconBytes good = encoded({{1, 2, 3}, 0, 0});
  for (std::size_t i = 0; i < good.size(); ++i) {
    if (i == 14) continue; // byte without a meaning
    for (int value = 0; value < 256; ++value) {
      FalconBytes bytes = good;
      bytes[i] = static_cast<std::byte>(value);
      const bool fits = i == 0    ? value == '<'
                        : i == 15 ? value == '>'
                        : i == 13 ? value >= 0x41 && value <= 0xc0
                                  : value >= 0x41 && value <= 0x50;
      ASSERT_EQ(decoded(bytes).has_value(), fits) << i << " " << value;
    }
  }
}

// Ten million torques of every kind that a double has.
TEST(FalconFrame, NeverExceedsTheMotorLimitNorFlipsTheSign) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> ordinary(0, 0.2);
  const auto any = [&](int kind) {
    switch (kind) {
    case 0:
      return std::bit_cast<double>(random()); // NaN, infinite, denormal, huge
    case 1:
      return ordinary(random);
    case 2:
      return ordinary(random) * std::numeric_limits<double>::denorm_min() * 1e3;
    default:
      return std::copysign(3.2767 + 1e-4 * static_cast<double>(random() & 15), ordinary(random));
    }
  };
  const double per_torque = kMaxMotor / kFalconFullTorque;
  for (int i = 0; i < 10'000'000; ++i) {
    const int kind = static_cast<int>(random() & 3);
    const Vec3 torques(any(kind), any(i & 3), any(kind));
    const auto values = motorValues(torques, per_torque);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double asked = torques[static_cast<int>(axis)];
      ASSERT_LE(std::abs(int{values[axis]}), kMaxMotor);
      if (values[axis] != 0) {
        ASSERT_TRUE(torques.allFinite());
        ASSERT_EQ(values[axis] > 0, asked > 0);
        ASSERT_LE(std::abs(values[axis]), std::abs(asked) * per_torque + 1e-9);
      }
    }
  }
}

TEST(FalconFrame, KeepsTheDirectionOfALimitedForce) {
  const auto values = motorValues(Vec3(1, -2, 0.5), kMaxMotor / kFalconFullTorque);
  EXPECT_EQ(values[0], 2047);
  EXPECT_EQ(values[1], -kMaxMotor);
  EXPECT_EQ(values[2], 1023);
}

struct Firmware {
  explicit Firmware(std::size_t size = 8000) : file(test::freshFolder("falcon") / "firmware.bin") {
    const auto image = madeUpFirmware(size);
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(size));
  }
  ~Firmware() { fs::remove_all(file.parent_path()); }
  fs::path file;
};

std::string fileErrorOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST(FalconFirmware, RequiresTheRightSizeAndAVerifiedHash) {
  const Firmware good, small(7000);
  const std::string name = good.file.string();
  std::string text(8000, 0);
  std::ifstream(good.file, std::ios::binary).read(text.data(), 8000);
  const std::string digest = sha256(text);
  EXPECT_EQ(readFalconFirmware(good.file, digest), madeUpFirmware());
  EXPECT_EQ(readFalconFirmware(good.file, "any"), madeUpFirmware());
  EXPECT_EQ(fileErrorOf([&] { (void)readFalconFirmware(small.file, "any"); }),
            small.file.string() + ": is no firmware of a Falcon: it has 7000 bytes, a firmware "
                                  "has 7324 to 8492");
  EXPECT_EQ(fileErrorOf([&] { (void)readFalconFirmware(good.file, ""); }),
            name +
                ": this firmware is not verified: if its SHA-256 is that of the maker's "
                "file, set PATINA_FALCON_SHA256=" +
                digest);
  const std::string other(64, '0');
  EXPECT_EQ(fileErrorOf([&] { (void)readFalconFirmware(good.file, other); }),
            name + ": is not the verified firmware: its SHA-256 is " + digest +
                ", PATINA_FALCON_SHA256 is " + other);
  EXPECT_NE(fileErrorOf([&] { (void)readFalconFirmware("/nowhere/at/all", "any"); }), "");
}

TEST(FalconBringUp, DoesNotReloadARunningFirmware) {
  FalconRig rig;
  EXPECT_TRUE(rig.waitUntilOk(0.5));
  EXPECT_LT(rig.clock->now(), 0.1);
}

TEST(FalconBringUp, LoadsMissingFirmwareAndHomesWithEitherBit) {
  const Firmware file;
  for (const std::uint8_t bit : kHomingBits) {
    FalconRig rig(
        {.homing_bit = bit, .runs_firmware = false, .homed = false, .firmware = madeUpFirmware()},
        {file.file, "any"});
    while (rig.clock->now() < 10 && rig.tick(Vec3::Zero()).status != DeviceStatus::ok)
      ASSERT_EQ(rig.notes->cause(), "") << "nothing keeps it from loading";
    EXPECT_LT(rig.clock->now(), 10);
    EXPECT_TRUE(rig.bench.runsFirmware());
    for (const SentFrame& frame : rig.sent) EXPECT_FALSE(frame.force());
  }
}

// Five of a hundred chunks are lost or echoed late, and each time it is another five.
TEST(FalconBringUp, LoadsWithinTenSecondsIfOneChunkInTwentyIsLost) {
  const Firmware file;
  double longest = 0;
  int loaded = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    FalconRig rig({.runs_firmware = false,
                   .firmware = madeUpFirmware(),
                   .chunk_loss = 0.025,
                   .chunk_late = 0.025,
                   .seed = seed},
                  {file.file, "any"});
    const bool ok = rig.waitUntilOk(10);
    EXPECT_TRUE(ok || rig.notes->cause().starts_with("the Falcon does not take its firmware: "))
        << seed << ": " << rig.notes->cause();
    loaded += ok ? 1 : 0;
    longest = std::max(longest, rig.clock->now());
  }
  EXPECT_EQ(loaded, 100);
  EXPECT_LE(longest, 10);
  std::printf("%d of 100 loaded, the longest in %.1f s\n", loaded, longest);
}

TEST(FalconBringUp, ReportsMissingPartsInOneSentence) {
  const auto causeAfter = [](double seconds, const FalconEmulatorSpec& spec,
                             const FalconFirmwareSource& source, bool attached = true) {
    FalconRig rig(spec, source);
    if (!attached) rig.bench.unplug();
    EXPECT_FALSE(rig.waitUntilOk(seconds));
    for (const SentFrame& frame : rig.sent) EXPECT_FALSE(frame.force());
    return rig.notes->cause();
  };
  const Firmware file;
  EXPECT_EQ(causeAfter(0.2, {}, {}, false), "the emulated Falcon is not attached");
  EXPECT_TRUE(causeAfter(1, {.runs_firmware = false}, {})
                  .starts_with("the Falcon runs no firmware: set PATINA_FALCON_FIRMWARE"));
  EXPECT_TRUE(causeAfter(1, {.runs_firmware = false}, {"/nowhere.bin", "any"})
                  .starts_with("/nowhere.bin: "));
  const std::string refused = causeAfter(10, {.runs_firmware = false}, {file.file, "any"});
  EXPECT_TRUE(refused.starts_with(
      "the Falcon does not take its firmware: chunk 1 of 130 came back changed, 4 times"))
      << refused;
  EXPECT_EQ(refused.find('\n'), std::string::npos);
}

TEST(FalconDevice, ReportsThePositionToOneEncoderCount) {
  FalconRig rig;
  ASSERT_TRUE(rig.waitUntilOk(1));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-0.6, 0.6);
  double worst = 0;
  for (int place = 0; place < 30; ++place) {
    rig.bench.rest =
        Vec3(part(random), part(random), part(random)).cwiseProduct(kFalconWorkspace.max());
    for (int i = 0; i < 400; ++i) rig.tick(Vec3::Zero());
    const DeviceState state = rig.tick(Vec3::Zero());
    ASSERT_EQ(state.status, DeviceStatus::ok);
    worst = std::max(worst, (state.position - rig.bench.handle()).norm());
  }
  EXPECT_LT(worst, 1e-4); // half a count of three legs
  EXPECT_GT(worst, 1e-6); // the position has the resolution of counts
}

TEST(FalconDevice, RendersTheRequestedForce) {
  FalconRig rig({.body = {.mass = 0.25, .damping = 20, .spring = 400, .friction = 0}});
  for (const Vec3& force : {Vec3(1, 0, 0), Vec3(0, -2, 0), Vec3(0.5, 0.5, 2), Vec3(0, 0, -1)}) {
    ASSERT_TRUE(rig.waitUntilFelt(force));
    for (int i = 0; i < 2000; ++i) rig.tick(force);
    EXPECT_LT((rig.bench.motorForce() - force).norm(), 0.01) << force.transpose();
    EXPECT_LT((rig.bench.handle() - force / 400).norm(), 5e-5); // the hand's spring balances it
  }
}

TEST(FalconDevice, ScalesForcesAboveItsLimitAndSendsNoInvalidOnes) {
  FalconRig rig({.body = {.mass = 0.25, .damping = 20, .spring = 2000, .friction = 0}});
  ASSERT_TRUE(rig.waitUntilFelt(Vec3(1, 0, 0)));
  const double most = falconGuard().max_force;
  for (const double scale : {10.0, 1e6, 1e300}) {
    for (int i = 0; i < 50; ++i) rig.tick(scale * Vec3(0, 3, 4));
    const Vec3 felt = rig.bench.motorForce();
    EXPECT_NEAR(felt.norm(), most, 0.02);
    EXPECT_LT((felt.normalized() - Vec3(0, 0.6, 0.8)).norm(), 0.01);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& force : {Vec3(nan, 0, 0), Vec3(0, HUGE_VAL, 0)}) {
    rig.tick(Vec3(1, 0, 0));
    rig.tick(force);
    EXPECT_FALSE(rig.sent.back().force());
    ASSERT_TRUE(rig.waitUntilFelt(Vec3(1, 0, 0)));
  }
}

} // namespace
} // namespace patina::test
