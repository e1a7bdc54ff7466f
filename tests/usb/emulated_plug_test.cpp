// Tests the replies of an emulated device by the messages of its socket.
#include "support/emulated_plug.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <sys/socket.h>
#include <sys/un.h>
#include <thread>
#include <unistd.h>

#include "core/descriptor.h"
#include "core/error.h"
#include "support/mute_transport.h"
#include "support/usbfs_wire.h"

namespace patina::test {
namespace {

namespace fs = std::filesystem;

class Quiet final : public MuteTransport {
 public:
  explicit Quiet(bool held) : held_(held) {}
  UsbResult claim(int) noexcept override { return held_ ? UsbResult::failed : UsbResult::ok; }
  UsbCount write(std::uint8_t, std::span<const std::byte> data, unsigned) noexcept override {
    return {UsbResult::ok, data.size()};
  }
  UsbCount read(std::uint8_t, std::span<std::byte>, unsigned timeout_ms) noexcept override {
    std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
    return {UsbResult::timeout, 0};
  }

 private:
  bool held_;
};

struct Program {
  explicit Program(const fs::path& node) : socket(::socket(AF_UNIX, SOCK_SEQPACKET, 0)) {
    sockaddr_un place{};
    place.sun_family = AF_UNIX;
    std::strncpy(place.sun_path, node.c_str(), sizeof place.sun_path - 1);
    EXPECT_EQ(::connect(socket.get(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
    EXPECT_EQ(next().kind, UsbfsMessage::hello);
  }
  UsbfsMessage next() const {
    UsbfsMessage message{.status = 1};
    EXPECT_EQ(::recv(socket.get(), &message, sizeof message, 0),
              static_cast<ssize_t>(sizeof message));
    return message;
  }
  void tell(const UsbfsMessage& message) const {
    EXPECT_EQ(::send(socket.get(), &message, sizeof message, 0),
              static_cast<ssize_t>(sizeof message));
  }
  int claim() const {
    tell({.kind = UsbfsMessage::claim});
    return next().status;
  }
  Descriptor socket;
};

class EmulatedPlugs : public testing::Test {
 protected:
  EmulatedPlugs() : folder_(fs::temp_directory_path() / ("plug" + std::to_string(getpid()))) {}
  ~EmulatedPlugs() override { fs::remove_all(folder_); }
  fs::path folder_;
  EmulatedUsb device_{.vendor = 1, .product = 2, .maker = "a", .name = "b", .endpoints = {{0x81}}};
};

TEST_F(EmulatedPlugs, WaitingReadsEndWithTheReleaseAndNoTransferFollows) {
  const EmulatedUsbDevice plug(folder_, device_, [] { return std::make_unique<Quiet>(false); });
  const Program program(plug.node());
  ASSERT_EQ(program.claim(), 0);
  program.tell({.kind = UsbfsMessage::submit, .id = 7, .type = 3, .endpoint = 0x81, .bytes = 8});
  program.tell({.kind = UsbfsMessage::release});
  const UsbfsMessage ended = program.next();
  EXPECT_EQ(ended.kind, UsbfsMessage::done);
  EXPECT_EQ(ended.id, 7u);
  EXPECT_EQ(ended.status, -ENOENT);
  EXPECT_EQ(program.next().kind, UsbfsMessage::reply);
  const std::clock_t spent = std::clock();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_LT(static_cast<double>(std::clock() - spent) / CLOCKS_PER_SEC, 0.1) << "it spins";
}

TEST_F(EmulatedPlugs, FailedClaimBlocksNoOtherProgram) {
  bool held = true;
  const EmulatedUsbDevice plug(folder_, device_,
                               [&] { return std::make_unique<Quiet>(std::exchange(held, false)); });
  const Program first(plug.node()), second(plug.node());
  EXPECT_EQ(first.claim(), -EBUSY);
  EXPECT_EQ(second.claim(), 0);
  EXPECT_EQ(first.claim(), -EBUSY) << "the second has it";
}

TEST_F(EmulatedPlugs, FullBusIsReported) {
  for (int i = 2; i < 128; ++i)
    fs::create_directories(folder_ / "sys/bus/usb/devices" / ("1-" + std::to_string(i)));
  EXPECT_THROW(EmulatedUsbDevice(folder_, device_, [] { return std::make_unique<Quiet>(false); }),
               FileError);
}

} // namespace
} // namespace patina::test
