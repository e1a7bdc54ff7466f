// The clip plane, by keys and its handle.
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "visualization/values/camera.h"

namespace patina {
namespace {

class ClipPlaneTest : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 12), "ball.obj")));
    show(Layer::tip, false);
    show(Layer::scale, false);
    clickAction("desk_feel");
    openTab("show");
    pointAt(inView({0, 150}));
    view().setFocus();
  }
  void turnOn() {
    type('s', kShift);
    ASSERT_TRUE(isShown("clip"));
    wait(150);
  }
  // Returns a point of the scene on the screen.
  QPoint onScreen(const Vec3& point) {
    vtkRenderer& renderer = view().view().renderer();
    double x = point.x(), y = point.y(), z = point.z();
    renderer.WorldToView(x, y, z);
    return view().mapToGlobal(
        QPoint(qRound((x + 1) / 2 * view().width()), qRound((1 - y) / 2 * view().height())));
  }
  // Shares of pixels that show the cut front (outside) and the visible inner side.
  double outside() {
    return share([](int r, int g, int b) { return g > 150 && g > r + 12 && g > b + 15; });
  }
};

TEST_F(ClipPlaneTest, AppearsByItsKeyAndDisappearsWithoutATrace) {
  if (IsSkipped()) return;
  wait(300);
  const double before = outside();
  const QImage whole = view().grabFramebuffer();
  ASSERT_GT(before, 0.03);
  turnOn();
  EXPECT_TRUE(find<QAction>("show_clip")->isChecked());
  EXPECT_LT(outside(), 0.7 * before);
  clickRow("clip");
  pointAt(inView({0, 150}));
  ASSERT_FALSE(find<QAction>("show_clip")->isChecked());
  ASSERT_TRUE(waitUntil([&] { return view().frames().settled(); }, 5000));
  wait(300);
  EXPECT_NEAR(outside(), before, 1e-3);
}

TEST_F(ClipPlaneTest, ShiftsByItsBallAndTiltsByItsHead) {
  if (IsSkipped()) return;
  const Vec3 eye(view().view().renderer().GetActiveCamera()->GetPosition());
  turnOn();
  const Vec3 normal = -Vec3::UnitY(), centre = view().view().extent().center();
  const double half = outside();
  drag(onScreen(centre), onScreen(centre + 0.02 * normal));
  EXPECT_GT(outside(), 1.1 * half) << "the cut is smaller";
  drag(onScreen(centre + 0.02 * normal), onScreen(centre));
  EXPECT_NEAR(outside(), half, 0.01);
  const double length = view().view().handleLength(false);
  drag(onScreen(centre + length * normal), onScreen(centre + length * Vec3::UnitX()));
  EXPECT_GT(std::abs(outside() - half), 0.01);
  EXPECT_EQ(Vec3(view().view().renderer().GetActiveCamera()->GetPosition()), eye)
      << "the camera stays";
  clickOn("clip_y");
  pointAt(inView({0, 150}));
  wait(100);
  EXPECT_NEAR(outside(), half, 0.01) << "across y again";
  clickOn("clip_flip");
  pointAt(inView({0, 150}));
  wait(100);
  EXPECT_GT(outside(), 1.1 * half) << "the half towards the eye is kept";
}

TEST_F(ClipPlaneTest, HidesTheCutPartFromThePointer) {
  if (IsSkipped()) return;
  pointAt(inView({40, 40}));
  ASSERT_TRUE(view().underPointer().has_value());
  turnOn();
  pointAt(inView({41, 40}));
  EXPECT_FALSE(view().underPointer().has_value()) << "the sight begins within the ball";
}

} // namespace
} // namespace patina
