// The side panel shows the scene's values; an absent value has no row.
#include <QLabel>
#include <QMenu>
#include <QToolButton>

#include "app/gui/toolkit/value_row.h"
#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"

namespace patina {
namespace {

class Panels : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 16), "sphere.obj")));
  }
  ValueRow* row(const char* name) { return find<ValueRow>(name); }
  void add(const QString& what) {
    addProperty(what);
    settle();
  }
  // Waits until the servo uses the panel's values.
  void settle() {
    waitUntil(
        [&] {
          return edits().scene() != nullptr &&
                 edits().scene()->scene.haptics == find<HapticsPanel>()->values();
        },
        20000);
    wait(60);
  }
  double warmShare() {
    return share([](int r, int g, int b) { return r > b + 40 && r > g + 25; });
  }
};

TEST_F(Panels, FrictionHasNoRowAndNoStageUntilAdded) {
  EXPECT_EQ(row("friction_static"), nullptr);
  EXPECT_FALSE(find<QLabel>("stages")->text().contains(QStringLiteral("friction")));
  add(QStringLiteral("Friction"));
  ASSERT_NE(row("friction_static"), nullptr);
  EXPECT_TRUE(find<QLabel>("stages")->text().contains(QStringLiteral("friction")));
  EXPECT_TRUE(edits().scene()->scene.haptics.friction.has_value());
  emit row("friction_static")->removed();
  settle();
  EXPECT_EQ(row("friction_static"), nullptr);
  EXPECT_FALSE(edits().scene()->scene.haptics.friction.has_value());
  EXPECT_FALSE(find<QLabel>("stages")->text().contains(QStringLiteral("friction")));
}

TEST_F(Panels, DampingAndTipRadiusAppearWhenAdded) {
  add(QStringLiteral("Damping"));
  add(QStringLiteral("Tip radius"));
  ASSERT_NE(row("damping"), nullptr);
  ASSERT_NE(row("tip_radius"), nullptr);
  EXPECT_EQ(edits().scene()->scene.haptics.tip_radius, 1e-3);
  setRow("tip_radius", 2.0);
  settle();
  EXPECT_EQ(edits().scene()->scene.haptics.tip_radius, 2e-3);
}

TEST_F(Panels, StaticFrictionNeverFallsBelowDynamic) {
  add(QStringLiteral("Friction"));
  setRow("friction_dynamic", 0.9);
  settle();
  EXPECT_EQ(edits().scene()->scene.haptics.friction->static_coefficient, 0.9);
  setRow("friction_static", 0.2);
  settle();
  EXPECT_EQ(edits().scene()->scene.haptics.friction->dynamic_coefficient, 0.2);
}

TEST_F(Panels, DrawTheSliceOnRequest) {
  show(Layer::tip, false); // the tool has warm colours too
  EXPECT_EQ(warmShare(), 0);
  show(Layer::slice, true);
  EXPECT_GT(warmShare(), 0.01);
  show(Layer::slice, false);
  EXPECT_EQ(warmShare(), 0);
}

TEST_F(Panels, SurviveAFrameBetweenRequestAndSlice) {
  show(Layer::slice, true);
  view().renderWindow()->Render(); // a resize renders too
  show(Layer::tip, false);
  EXPECT_GT(warmShare(), 0.01);
}

TEST_F(Panels, WireframeDarkensTheSurface) {
  const auto dark = [this] {
    return share([](int r, int g, int b) { return g > b && g >= r && r + g + b < 330; });
  };
  const double before = dark();
  show(Layer::wireframe, true);
  EXPECT_GT(dark(), before + 0.01);
}

TEST_F(Panels, StatusLineShowsTheServo) {
  wait(600);
  const QString rate = find<QLabel>("rate")->text();
  EXPECT_TRUE(rate.endsWith(QStringLiteral("Hz"))) << rate.toStdString();
  EXPECT_NEAR(rate.split(' ').front().toDouble(), 1000, 200);
  EXPECT_TRUE(find<QLabel>("stages")->text().contains(QStringLiteral("limit")));
}

} // namespace
} // namespace patina
