// The report on an attached device: its state, the program that has it, its response time.
#include "usb/usb_check.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <unistd.h>

#include "support/scripted_transport.h"

namespace patina {
namespace {

using test::ScriptedTransport;
using test::UsbStep;
using Kind = UsbStep::Kind;

const UsbStep kStatus{Kind::control_in, 0, {0x80, 0, 0, 0}, test::bytes({1, 0})};

UsbCheck checked(std::vector<UsbStep> steps, int requests, const char* haptic = "Novint Falcon") {
  UsbDevice device;
  device.haptic = haptic;
  device.openable = true;
  ScriptedTransport usb(std::move(steps));
  UsbCheck check = checkUsb(device, usb, requests);
  EXPECT_TRUE(usb.done()) << usb.complaint();
  return check;
}

TEST(UsbCheck, ReportsAnIntactDeviceAsReadyWithItsTime) {
  const UsbCheck check = checked({kStatus, kStatus, kStatus, {Kind::claim, 0}}, 3);
  EXPECT_EQ(stateText(check), "ready");
  EXPECT_EQ(check.round_trips.size(), 3u);
  for (const double us : check.round_trips) EXPECT_GE(us, 0);
}

TEST(UsbCheck, ClaimsNoInterfaceOfAnUnknownDevice) {
  EXPECT_EQ(stateText(checked({kStatus}, 1, "")), "ready");
}

TEST(UsbCheck, ReportsTheCauseOfARefusal) {
  UsbStep silent = kStatus, gone = kStatus;
  silent.result = UsbResult::timeout;
  gone.result = UsbResult::gone;
  EXPECT_EQ(stateText(checked({silent}, 5)), "does not answer");
  const UsbCheck check = checked({kStatus, gone}, 5);
  EXPECT_EQ(stateText(check), "is gone");
  EXPECT_EQ(check.round_trips.size(), 1u);
  EXPECT_EQ(stateText(checked({kStatus, {Kind::claim, 0, {}, {}, UsbResult::failed}}, 1)),
            "in use by a driver or another program");
  UsbDevice closed;
  closed.refusal = UsbAccessError::permission;
  EXPECT_EQ(stateText(checkUsb(closed)), "no permission");
  EXPECT_EQ(stateText({{}, UsbAccessError::held_by_driver, "spacenavd (813)"}),
            "in use by spacenavd (813)");
}

TEST(UsbCheck, CountsEachRoundTripOnce) {
  const std::vector<double> trips{0, 99.9, 100, 100.1, 4000, 1e9};
  const auto counts = histogram(trips);
  EXPECT_EQ(counts, (std::array<std::size_t, 8>{3, 1, 0, 0, 0, 1, 0, 1}));
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::size_t{0}), trips.size());
}

TEST(SerialProbes, AreFoundByTheNameOfTheDeviceBehindThePort) {
  namespace fs = std::filesystem;
  const fs::path root = fs::path(testing::TempDir()) / ("serial" + std::to_string(getpid()));
  const auto device = [&](const char* product, const char* port) {
    const fs::path usb = root / "devices" / port, interface = usb / "1-1:1.0";
    fs::create_directories(interface);
    std::ofstream(usb / "product") << product << "\n";
    fs::create_directories(root / "tty" / port);
    fs::create_directory_symlink(interface, root / "tty" / port / "device");
  };
  device("Patina probe mk2", "ttyACM3");
  device("Patina probe", "ttyACM1");
  device("A modem", "ttyACM0");
  device("Patina probe", "tty7");
  fs::create_directories(root / "dev");
  std::ofstream(root / "dev" / "ttyACM1") << "";
  const auto found = listSerialProbes(root / "tty", root / "dev");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].path, (root / "dev" / "ttyACM1").string());
  EXPECT_TRUE(found[0].openable);
  EXPECT_EQ(found[1].name, "Patina probe mk2");
  EXPECT_FALSE(found[1].openable);
  fs::remove_all(root);
}

} // namespace
} // namespace patina
