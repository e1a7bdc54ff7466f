// The live curves below the picture, by pointer and keys.
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"

namespace patina {
namespace {

class StripPlotTest : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 12), "ball.obj")));
    plot_ = find<ForcePlot>();
    if (!plot_->isVisible()) clickOn("page_forces");
    ASSERT_TRUE(plot_->isVisible());
    touch();
  }
  // The tip goes into the ball and out again.
  void touch() {
    pointAt(inView({0, 0}));
    wheelAt(inView({0, 0}), 14);
    wait(150);
    wheelAt(inView({0, 0}), -14);
    wait(150);
  }
  QImage picture() {
    wait(100);
    return plot_->grab().toImage();
  }
  QPoint inPlot(double part) {
    return plot_->mapToGlobal({static_cast<int>(part * plot_->width()), plot_->height() / 2});
  }
  QToolButton& holds() { return *plot_->findChild<QToolButton*>("hold"); }
  ForcePlot* plot_ = nullptr;
};

TEST_F(StripPlotTest, HeldPlotStandsStillWhileTicksAreRecorded) {
  if (IsSkipped()) return;
  pointAt(inView({200, 150}));
  const QImage runs = picture();
  // A curve without new data stops after a while: the tip moves until the test has seen it run.
  EXPECT_TRUE(waitUntil(
      [&] {
        touch();
        return picture() != runs;
      },
      20000));
  type('r', kControl);
  ASSERT_TRUE(waitUntil([&] { return feel().recording(); }, 3000));
  click(holds());
  pointAt(inView({0, 0}));
  const QImage held = picture();
  const double recorded = feel().recordedSeconds();
  touch();
  EXPECT_EQ(picture(), held);
  EXPECT_GT(feel().recordedSeconds(), recorded + 0.2);
  click(holds());
  pointAt(inView({0, 0}));
  EXPECT_NE(picture(), held);
}

TEST_F(StripPlotTest, WheelHoldsAndZoomsDragShiftsDoubleClickFollows) {
  if (IsSkipped()) return;
  wheelAt(inPlot(0.5), 2);
  EXPECT_TRUE(holds().isChecked());
  const QImage zoomed = picture();
  drag(inPlot(0.5), inPlot(0.6));
  const QImage shifted = picture();
  EXPECT_NE(shifted, zoomed);
  drag(inPlot(0.6), inPlot(0.5));
  EXPECT_TRUE(waitUntil([&] { return picture() == zoomed; }, 3000)) << "there and back";
  wheelAt(inPlot(0.5), -2);
  doubleClickAt(inPlot(0.5));
  EXPECT_FALSE(holds().isChecked());
}

TEST_F(StripPlotTest, SpaceHoldsTheFocusedPlotAndElsewhereMovesTheCamera) {
  if (IsSkipped()) return;
  pointAt(inPlot(0.5)), press(), release();
  type(' ');
  EXPECT_TRUE(holds().isChecked());
  EXPECT_FALSE(find<QAction>("tool_navigate")->isChecked());
  type(' ');
  EXPECT_FALSE(holds().isChecked());
  view().setFocus();
  type(' ');
  EXPECT_FALSE(holds().isChecked());
  EXPECT_TRUE(find<QAction>("tool_navigate")->isChecked());
}

} // namespace
} // namespace patina
