// Absent value, absent panel: the side panel shows what the scene has.
#include <QLabel>
#include <QMenu>
#include <QToolButton>

#include "app/gui/panels/value_row.h"
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
  ValueRow* row(const char* name) {
    return window_->haptics().findChild<ValueRow*>(QString::fromUtf8(name));
  }
  void add(const QString& what) {
    auto* button = window_->haptics().findChild<QToolButton*>(QStringLiteral("add_property"));
    for (QAction* action : button->menu()->actions())
      if (action->text() == what) action->trigger();
    settle();
  }
  // The servo's values have come where the panel wants them.
  void settle() {
    waitUntil(
        [&] {
          return window_->scene() != nullptr &&
                 window_->scene()->scene.haptics == window_->haptics().values();
        },
        20000);
    wait(60);
  }
  double warmShare() {
    return share([](int r, int g, int b) { return r > b + 40 && r > g + 25; });
  }
};

TEST_F(Panels, FrictionHasNoRowAndNoStageUntilItIsAdded) {
  EXPECT_EQ(row("friction_static"), nullptr);
  EXPECT_FALSE(window_->status().stagesText().contains(QStringLiteral("friction")));
  add(QStringLiteral("Friction"));
  ASSERT_NE(row("friction_static"), nullptr);
  EXPECT_TRUE(window_->status().stagesText().contains(QStringLiteral("friction")));
  EXPECT_TRUE(window_->scene()->scene.haptics.friction.has_value());
  emit row("friction_static")->removed();
  settle();
  EXPECT_EQ(row("friction_static"), nullptr);
  EXPECT_FALSE(window_->scene()->scene.haptics.friction.has_value());
  EXPECT_FALSE(window_->status().stagesText().contains(QStringLiteral("friction")));
}

TEST_F(Panels, DampingAndTipRadiusAppearWhenAdded) {
  add(QStringLiteral("Damping"));
  add(QStringLiteral("Tip radius"));
  ASSERT_NE(row("damping"), nullptr);
  ASSERT_NE(row("tip_radius"), nullptr);
  EXPECT_EQ(window_->scene()->scene.haptics.tip_radius, 1e-3);
  emit row("tip_radius")->edited(2.0);
  settle();
  EXPECT_EQ(window_->scene()->scene.haptics.tip_radius, 2e-3);
}

TEST_F(Panels, StaticFrictionNeverFallsBelowDynamic) {
  add(QStringLiteral("Friction"));
  emit row("friction_dynamic")->edited(0.9);
  settle();
  EXPECT_EQ(window_->scene()->scene.haptics.friction->static_coefficient, 0.9);
  emit row("friction_static")->edited(0.2);
  settle();
  EXPECT_EQ(window_->scene()->scene.haptics.friction->dynamic_coefficient, 0.2);
}

TEST_F(Panels, TheSliceIsDrawnWhenItIsAskedFor) {
  window_->display().setShown(Layer::tip, false); // the tool is warm too
  EXPECT_EQ(warmShare(), 0);
  window_->display().setShown(Layer::slice, true);
  EXPECT_GT(warmShare(), 0.01);
  window_->display().setShown(Layer::slice, false);
  EXPECT_EQ(warmShare(), 0);
}

TEST_F(Panels, AFrameMayComeBetweenTheWishForASliceAndTheSlice) {
  window_->display().setShown(Layer::slice, true);
  view().renderWindow()->Render(); // as for a resize
  window_->display().setShown(Layer::tip, false);
  EXPECT_GT(warmShare(), 0.01);
}

TEST_F(Panels, WireframeDarkensTheSurface) {
  const auto dark = [this] {
    return share([](int r, int g, int b) { return g > b && g >= r && r + g + b < 330; });
  };
  const double before = dark();
  window_->display().setShown(Layer::wireframe, true);
  EXPECT_GT(dark(), before + 0.01);
}

TEST_F(Panels, TheStatusLineShowsTheServo) {
  wait(600);
  const QString rate = window_->findChild<QLabel*>(QStringLiteral("rate"))->text();
  EXPECT_TRUE(rate.endsWith(QStringLiteral("Hz"))) << rate.toStdString();
  EXPECT_NEAR(rate.split(' ').front().toDouble(), 1000, 200);
  EXPECT_TRUE(window_->status().stagesText().contains(QStringLiteral("limit")));
}

} // namespace
} // namespace patina
