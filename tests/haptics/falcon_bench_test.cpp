// The emulated Falcon at its wire, without the driver: the basis of the driver's tests.
#include "haptics/falcon/emulated_falcon.h"

#include <gtest/gtest.h>

#include "haptics/falcon/falcon_device.h"
#include "haptics/falcon/falcon_frame.h"
#include "haptics/falcon/falcon_kinematics.h"

namespace patina {
namespace {

std::vector<std::byte> bytesOf(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

// A host with the bench on its bus.
struct Host {
  explicit Host(const FalconEmulatorSpec& spec = {}) : bench(spec, clock), usb(bench.plug()) {
    set(9, 1); // an empty packet after a millisecond
  }
  void set(int request, int value) {
    const auto code = static_cast<std::uint8_t>(request);
    EXPECT_EQ(usb->controlOut({0x40, code, static_cast<std::uint16_t>(value), 0}, {}, 10).result,
              UsbResult::ok);
  }
  void send(std::span<const std::byte> bytes) {
    EXPECT_EQ(usb->write(0x02, bytes, 10).bytes, bytes.size());
  }
  // One packet, without the bridge's two bytes.
  std::vector<std::byte> packet() {
    std::array<std::byte, 64> read;
    const UsbCount got = usb->read(0x81, read, 1000);
    EXPECT_EQ(got.result, UsbResult::ok);
    return {read.begin() + 2, read.begin() + static_cast<std::ptrdiff_t>(got.bytes)};
  }
  // Returns all that arrives within `seconds`.
  std::vector<std::byte> heard(double seconds) {
    std::vector<std::byte> all;
    for (const double until = clock->now() + seconds; clock->now() < until;) {
      const auto some = packet();
      all.insert(all.end(), some.begin(), some.end());
    }
    return all;
  }

  std::shared_ptr<SimulatedClock> clock = std::make_shared<SimulatedClock>();
  FalconEmulator bench;
  std::unique_ptr<UsbTransport> usb;
};

TEST(FalconEmulator, IgnoresFramesWithInvalidEnds) {
  for (const std::size_t end : {0, 15}) {
    Host host;
    FalconBytes bytes = encoded({{1, 2, 3}, 0, 0});
    host.send(bytes);
    EXPECT_EQ(host.heard(0.01).size(), kFalconFrame);
    bytes[end] = std::byte{'A'};
    host.send(bytes);
    EXPECT_TRUE(host.heard(0.01).empty()) << end;
    EXPECT_EQ(host.bench.frames(), 1U);
  }
}

TEST(FalconEmulator, SendsAPacketWithTheAnswerNotTheLatencyTimer) {
  Host host({.answer = 220e-6});
  host.packet();
  host.send(encoded({}));
  const double sent = host.clock->now();
  EXPECT_EQ(host.packet().size(), kFalconFrame);
  EXPECT_NEAR(host.clock->now() - sent, 220e-6, 1e-9);
}

TEST(FalconEmulator, StaleAnswerPrecedesThisFramesAnswer) {
  Host host;
  host.send(encoded({}));
  const auto before = host.heard(0.005);
  host.bench.rest = Vec3(0, 0, 0.01); // the next answer has another position
  host.bench.faults = {WireFault::stale, 1};
  host.send(encoded({}));
  const auto both = host.heard(0.005);
  ASSERT_EQ(both.size(), 2 * kFalconFrame);
  EXPECT_TRUE(std::equal(before.begin(), before.end(), both.begin()));
}

TEST(FalconEmulator, GearsStartInTheMiddleOfTheirBacklash) {
  Host host({.backlash = 0.04}); // sixty counts
  host.send(encoded({}));
  const auto bytes = host.heard(0.005);
  ASSERT_EQ(bytes.size(), kFalconFrame);
  const auto answer = decoded(std::span<const std::byte, kFalconFrame>(bytes));
  const auto angles = falconAngles({}, kFalconCentre);
  ASSERT_TRUE(answer && angles);
  for (int leg = 0; leg < 3; ++leg)
    EXPECT_NEAR(kFalconIndex + kFalconCount * answer->encoders[static_cast<std::size_t>(leg)],
                (*angles)[leg], 0.51 * kFalconCount);
}

TEST(FalconEmulator, ResetRestartsTheBootLoaderEvenIfTheBridgeIsEmptied) {
  Host host({.runs_firmware = false});
  for (int round = 0; round < 2; ++round) {
    host.set(3, 0x4138);
    host.set(1, 0x0100);
    for (const int side : {1, 2}) host.set(0, side);
    host.set(1, 0x0101);
    host.send(bytesOf({0x0a, 0x43, 0x0d}));
    EXPECT_EQ(host.heard(0.02), bytesOf({0x00, 0x0a, 0x44, 0x2c, 0x0d})) << round;
  }
}

} // namespace
} // namespace patina
