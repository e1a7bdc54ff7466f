// The card's list of attached devices shows each state in words, with the one button that remedies
// it.
#include "app/gui/panels/device_panel.h"

#include <QComboBox>
#include <QPushButton>

#include "gui/window_fixture.h"
#include "support/places.h"

namespace patina {
namespace {

UsbCheck found(const char* name, std::optional<UsbAccessError> refusal) {
  UsbCheck check;
  check.device.name = name;
  check.device.haptic = name;
  check.device.megabits = 12;
  check.refusal = refusal;
  if (!refusal) check.round_trips = {120, 130, 900};
  return check;
}

TEST(AttachedRows, NameEachStateAndOneRemedy) {
  UsbCheck held = found("Novint Falcon", UsbAccessError::held_by_driver);
  held.holder = "spacenavd (813)";
  const auto rows = attachedRows({.usb = {found("Patina probe", std::nullopt),
                                          found("Novint Falcon", UsbAccessError::permission), held,
                                          found("3D Systems Touch", UsbAccessError::gone)},
                                  .serial = {{"/dev/ttyACM0", "Patina probe", false}},
                                  .plugins = {{.name = "old", .problem = "made for version 9"}}});
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0].words, "Patina probe: ready, for the Record card: usb:");
  EXPECT_EQ(rows[0].tip, "12 Mbit/s, answers within 130 µs, 99 of 100 times within 900 µs");
  EXPECT_EQ(rows[0].remedy, Remedy::none);
  EXPECT_EQ(rows[1].words, "Novint Falcon: no permission");
  EXPECT_EQ(rows[1].remedy, Remedy::allow);
  EXPECT_TRUE(rows[1].tip.contains("--install-udev"));
  EXPECT_EQ(rows[2].words, "Novint Falcon: in use by spacenavd (813)");
  EXPECT_EQ(rows[2].remedy, Remedy::look_again);
  EXPECT_EQ(rows[3].words, "3D Systems Touch: is gone");
  EXPECT_EQ(rows[4].remedy, Remedy::allow);
  EXPECT_EQ(rows[5].tip, "made for version 9");
}

TEST(AttachedRows, ReportThatNoDeviceIsAttached) {
  EXPECT_EQ(attachedRows({})[0].words, "No haptic device is attached");
  const auto rows = attachedRows({.problem = "the USB bus cannot be read: install libusb-1.0-0"});
  EXPECT_EQ(rows[0].words, "USB cannot be read");
  EXPECT_TRUE(rows[0].tip.contains("libusb"));
}

class AttachedCard : public WindowTest {
 protected:
  void SetUp() override {
    std::filesystem::copy_file(test::programFolder() / "patina_device_example.so",
                               plugins_ / "patina_device_example.so");
    setenv("PATINA_DEVICES", plugins_.c_str(), 1);
    WindowTest::SetUp();
  }
  void TearDown() override {
    WindowTest::TearDown();
    unsetenv("PATINA_DEVICES");
    std::filesystem::remove_all(plugins_);
  }
  const std::filesystem::path plugins_ = test::trustedFolder("plugins");
};

TEST_F(AttachedCard, OffersInstalledPluginsAndSearchesAgain) {
  if (IsSkipped()) return;
  auto* list = find<AttachedDevices>("attached");
  list->setParent(nullptr); // shown on every desk, without the panel around it
  list->QWidget::show();
  auto* device = find<QComboBox>("device");
  ASSERT_TRUE(waitUntil([&] { return device->findData("plugin:example") >= 0; }, 10000));
  EXPECT_EQ(device->itemText(device->findData("plugin:example")), "Example hand");
  const auto again = [&] {
    for (auto* button : list->findChildren<QPushButton*>())
      if (button->text() == "Look again" && button->isVisible()) return button;
    return static_cast<QPushButton*>(nullptr);
  };
  ASSERT_TRUE(waitUntil([&] { return again() != nullptr; }, 5000))
      << "no device is attached to a machine that builds";
  again()->click();
  EXPECT_FALSE(again()) << "it looks";
  EXPECT_TRUE(waitUntil([&] { return again() != nullptr; }, 10000));
  const int count = device->count();
  wait(100);
  EXPECT_EQ(device->count(), count) << "none is listed twice";
  delete list;
}

} // namespace
} // namespace patina
