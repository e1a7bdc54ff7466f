// Modes, device and stabilisers: the servo gets the panels' values.
#include <algorithm>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QToolButton>

#include "app/gui/toolkit/value_row.h"
#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"

namespace patina {
namespace {

constexpr double kBall = 0.03;

class TouchPanels : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(kBall, 30), "sphere.obj")));
  }
  void click(const char* name) {
    find<QToolButton>(name)->click();
    edits().previewValues(); // before the window's next tick
    edits().waitForEdits();
    wait(150);
  }
  const Scene& scene() { return edits().scene()->scene; }
  void pressMiddle(int notches) {
    send(QEvent::MouseButtonDblClick, middle(), Qt::LeftButton, Qt::LeftButton);
    turnWheel(notches);
    wait(400);
    waitUntil([&] { return (feel().sample().tip - view().target()).norm() < 1e-6; }, 5000);
  }
  double goldShare() {
    return share([](int r, int g, int b) { return r > b + 60 && g > b + 45; });
  }
};

TEST_F(TouchPanels, OffsetAndMagnetExcludeEachOther) {
  EXPECT_EQ(find<ValueRow>("offset"), nullptr);
  EXPECT_EQ(find<ValueRow>("magnet_range"), nullptr);
  click("mode_offset");
  EXPECT_TRUE(scene().haptics.offset.has_value());
  EXPECT_NE(find<ValueRow>("offset"), nullptr);
  click("mode_magnetic");
  EXPECT_FALSE(scene().haptics.offset.has_value());
  ASSERT_TRUE(scene().haptics.magnet.has_value());
  EXPECT_EQ(find<ValueRow>("offset"), nullptr);
  setRow("magnet_strength", 450);
  find<QCheckBox>("magnet_fades")->setChecked(false);
  ASSERT_TRUE(waitUntil([&] { return !scene().haptics.magnet->fades; }, 10000));
  EXPECT_EQ(scene().haptics.magnet->strength, 450);
  EXPECT_FALSE(scene().haptics.magnet->fades);
  click("mode_contact");
  ASSERT_TRUE(waitUntil([&] { return !scene().haptics.magnet.has_value(); }, 10000));
  click("mode_magnetic"); // the mode's values are restored
  ASSERT_TRUE(waitUntil([&] { return scene().haptics.magnet.has_value(); }, 10000));
  EXPECT_EQ(scene().haptics.magnet->strength, 450);
}

TEST_F(TouchPanels, OffsetActsOutsideAndContactIsDrawnOnTheSurface) { // K12
  click("mode_offset");
  setRow("offset", 1.0);
  wait(150);
  pressMiddle(2);
  const ToolSample sample = feel().sample();
  ASSERT_TRUE(sample.contact);
  const double depth = kBall + 1e-3 - sample.tip.norm();
  EXPECT_GT(depth, 3e-4);
  EXPECT_NEAR(sample.vcp.norm(), kBall + 1e-3, 1e-4);
  EXPECT_NEAR(sample.surface.norm(), kBall, 1e-4);
  EXPECT_NEAR(sample.force.norm(), 500 * depth, 0.05);
}

TEST_F(TouchPanels, BandIsShownOnlyWithAnOffsetOrAMagnet) {
  show(Layer::tip, false);
  EXPECT_TRUE(rowOf("band")->isHidden());
  EXPECT_EQ(goldShare(), 0);
  click("mode_offset");
  EXPECT_FALSE(rowOf("band")->isHidden());
  EXPECT_GT(goldShare(), 0.05);
  show(Layer::band, false);
  EXPECT_EQ(goldShare(), 0);
}

TEST_F(TouchPanels, MagnetPullsFromOutside) { // K13
  pressMiddle(0);
  turnWheel(-1);
  wait(300);
  ASSERT_EQ(feel().sample().force.norm(), 0);
  click("mode_magnetic");
  wait(400);
  const ToolSample sample = feel().sample();
  EXPECT_FALSE(sample.contact);
  EXPECT_TRUE(sample.attracted);
  EXPECT_LT(sample.force.dot(sample.tip), 0);
}

TEST_F(TouchPanels, ContactAndCutOffReachTheScene) {
  find<QCheckBox>("contact_proxy")->setChecked(false);
  addProperty("Damping");
  addProperty("Damping cut-off");
  setRow("damping_cutoff", 120);
  wait(150);
  EXPECT_EQ(scene().haptics.contact, HapticProperties::Contact::ray);
  EXPECT_EQ(scene().haptics.damping_cutoff, 120);
  emit find<ValueRow>("damping")->removed();
  wait(150);
  EXPECT_FALSE(scene().haptics.damping_cutoff.has_value());
}

TEST_F(TouchPanels, EditBeyondTheFieldIsReportedAndNotRendered) {
  const auto felt = edits().scene();
  HapticProperties haptics = find<HapticsPanel>()->values();
  haptics.offset = 0.2;
  find<HapticsPanel>()->setValues(haptics);
  emit find<HapticsPanel>()->edited(haptics);
  const auto notified = [&] {
    const auto labels = find<HapticsPanel>()->findChildren<QLabel*>();
    return std::any_of(labels.begin(), labels.end(), [](const QLabel* label) {
      return label->isVisible() && label->text().contains(QStringLiteral("band"));
    });
  };
  EXPECT_TRUE(waitUntil(notified, 3000));
  EXPECT_EQ(edits().scene(), felt);
}

TEST_F(TouchPanels, DeviceNumbersAppearForASimulatedDeviceAndStabiliseTheLoop) {
  EXPECT_EQ(find<QToolButton>("device_numbers"), nullptr);
  find<QComboBox>("device")->setCurrentIndex(1);
  wait(150);
  EXPECT_EQ(scene().device, "simulated");
  EXPECT_TRUE(feel().servo().running());
  EXPECT_EQ(find<QDoubleSpinBox>("device_mass"), nullptr);
  click("device_numbers");
  ASSERT_NE(find<QDoubleSpinBox>("device_mass"), nullptr);
  find<QDoubleSpinBox>("device_mass")->setValue(60);
  find<QDoubleSpinBox>("device_encoder")->setValue(30);
  setRow("stiffness", 8000);
  // 8000 N/m on a device of 0.5 N s/m at 1 kHz is past 2b/T: automatic switches the coupling on.
  ASSERT_TRUE(waitUntil(
      [&] { return find<QLabel>("stabilisers")->text().startsWith(QStringLiteral("coupling ")); }));
  ASSERT_TRUE(scene().device_model.has_value());
  EXPECT_NEAR(scene().device_model->mass, 0.06, 1e-12);
  EXPECT_NEAR(scene().device_model->encoder_step, 30e-6, 1e-15);
  EXPECT_TRUE(find<QLabel>("stabilisers")->text().endsWith(QStringLiteral(" N/m")));
  EXPECT_FALSE(find<QLabel>("stabilisers")->toolTip().isEmpty());
  find<QComboBox>("stabiliser")->setCurrentIndex(1); // none
  EXPECT_TRUE(waitUntil([&] { return find<QLabel>("stabilisers")->text().isEmpty(); }));
  find<QComboBox>("stabiliser")->setCurrentIndex(3); // passivity
  EXPECT_TRUE(waitUntil(
      [&] { return find<QLabel>("stabilisers")->text() == QStringLiteral("passivity"); }));
  click("device_numbers");
  EXPECT_TRUE(waitUntil([&] { return !scene().device_model.has_value(); }));
}

TEST_F(TouchPanels, EnergyRisesAsTheTipGoesIn) {
  pressMiddle(0);
  startLog();
  turnWheel(3);
  wait(500);
  const ToolSample sample = feel().sample();
  ASSERT_TRUE(sample.contact);
  const double depth = kBall - sample.tip.norm();
  const double spring = 0.5 * 500 * depth * depth;
  EnergyMeter meter;
  for (const ToolSample& tick : logged()) meter.add(tick);
  EXPECT_NEAR(meter.ledger.absorbed, spring, 0.1 * spring);
}

TEST_F(TouchPanels, StabilityMapAppearsOnRequest) {
  show(Layer::tip, false);
  setRow("stiffness", 8000);
  wait(150);
  const double sage = surfaceShare();
  ASSERT_GT(sage, 0.1);
  openTab("show");
  show(Layer::stability, true);
  auto* words = find<QLabel>("stability_words");
  EXPECT_TRUE(words->isVisible());
  ASSERT_TRUE(waitUntil([&] { return words->text().contains(QStringLiteral("K*/K")); }));
  EXPECT_LT(surfaceShare(), 0.5 * sage); // the map replaces the mesh
  EXPECT_TRUE(words->text().contains(QStringLiteral("100 %"))) << words->text().toStdString();
  show(Layer::stability, false);
  wait(60);
  EXPECT_FALSE(words->isVisible());
  EXPECT_GT(surfaceShare(), 0.9 * sage);
}

} // namespace
} // namespace patina
