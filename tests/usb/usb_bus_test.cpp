#include "usb/usb_bus.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "support/places.h"

namespace patina {
namespace {

TEST(UsbBus, IsListedOrGivesTheCause) {
  try {
    for (const UsbDevice& device : listUsbDevices()) {
      EXPECT_FALSE(device.name.empty());
      // A device without permission comes with advice.
      EXPECT_TRUE(device.openable || !device.advice.empty()) << device.name;
      EXPECT_EQ(device.haptic, hapticName(device.vendor, device.product));
    }
  } catch (const DeviceError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("the USB bus cannot be "));
  }
}

TEST(UsbBus, RefusesADetachedDeviceWithAdvice) {
  UsbDevice none;
  none.vendor = 0x0403;
  none.product = 0xffff; // an unassigned number
  none.name = "the device";
  none.bus = 250;
  try {
    (void)openUsb(none);
    ADD_FAILURE();
  } catch (const DeviceError& error) {
    const std::string cause = error.what();
    EXPECT_TRUE(cause.starts_with("the USB bus cannot be ") ||
                cause == "the device (USB 0403:ffff) is not attached: plug it in, and its power "
                         "supply too")
        << cause;
  }
}

TEST(UsbBus, RecognisesHapticDevicesOnly) {
  EXPECT_EQ(hapticName(0x0403, 0xcb48), "Novint Falcon");
  EXPECT_EQ(hapticName(0x0403, 0x6001), ""); // the same chip maker's plain serial adapter
  EXPECT_EQ(hapticName(0x1451, 0x0402), "Force Dimension");
  EXPECT_EQ(hapticName(0x2988, 0x0302), "3D Systems Touch");
  EXPECT_EQ(hapticName(0x1d6b, 0x0002), ""); // a root hub
}

TEST(UsbBus, AdviceForAMissingPermissionContainsTheRule) {
  const std::string advice = usbAdvice(UsbAccessError::permission, 0x0403, 0xcb48);
  EXPECT_NE(advice.find("ATTR{idVendor}==\"0403\", ATTR{idProduct}==\"cb48\""), std::string::npos);
  EXPECT_NE(advice.find("/etc/udev/rules.d/"), std::string::npos);
}

TEST(UsbBus, EveryRefusalHasItsOwnAdviceInOneLine) {
  std::vector<std::string> seen;
  for (const UsbAccessError refusal : {UsbAccessError::permission, UsbAccessError::held_by_driver,
                                       UsbAccessError::gone, UsbAccessError::other}) {
    const std::string advice = usbAdvice(refusal, 1, 2);
    EXPECT_EQ(advice.find('\n'), std::string::npos);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), advice), 0);
    seen.push_back(advice);
  }
}

TEST(UsbBus, UdevRulesEqualTheShippedOnesAndCoverEachDevice) {
  std::ifstream file(test::sourceFolder() / "data" / "70-patina.rules");
  std::stringstream shipped;
  shipped << file.rdbuf();
  EXPECT_EQ(shipped.str(), udevRules()) << "write it again: patina devices --install-udev data";
  EXPECT_NE(
      udevRules().find("ATTR{idVendor}==\"0403\", ATTR{idProduct}==\"cb48\", TAG+=\"uaccess\"\n"),
      std::string::npos);
  EXPECT_NE(udevRules().find("ATTR{product}==\"Patina probe*\""), std::string::npos);
}

} // namespace
} // namespace patina
