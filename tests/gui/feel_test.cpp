// The mouse as a haptic device: forces and pictures for a user without a device.
#include <cmath>

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>

#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"

namespace patina {
namespace {

constexpr double kRadius = 0.03;

class MouseFeels : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(kRadius, 30), "sphere.obj")));
  }
  // The wait covers slow drawing.
  void settle() {
    wait(250);
    waitUntil([&] { return (feel().sample().tip - view().target()).norm() < 1e-6; }, 5000);
  }
};

TEST_F(MouseFeels, DoubleClickSetsTheTipOntoTheSurface) {
  send(QEvent::MouseButtonDblClick, middle(), Qt::LeftButton, Qt::LeftButton);
  settle();
  EXPECT_NEAR(view().target().norm(), kRadius, 2e-4);
  EXPECT_NEAR(feel().sample().tip.norm(), kRadius, 2e-4);
}

TEST_F(MouseFeels, DrawnToolStaysOutsideWhileTheTipGoesIn) {
  send(QEvent::MouseButtonDblClick, middle(), Qt::LeftButton, Qt::LeftButton);
  turnWheel(6);
  settle();
  const ToolSample sample = feel().sample();
  ASSERT_TRUE(sample.contact);
  EXPECT_LT(sample.tip.norm(), kRadius - 1e-3);  // the true tip is inside
  EXPECT_NEAR(sample.vcp.norm(), kRadius, 1e-4); // the proxy is on the surface
  EXPECT_GT(sample.force.dot(sample.vcp), 0);    // the force points out
  const double expected = std::min(3.3, 500 * (kRadius - sample.tip.norm()));
  EXPECT_NEAR(sample.force.norm(), expected, 0.05 * expected);
  EXPECT_GT(forceShare(), 0.0005);
}

TEST_F(MouseFeels, NoForceAndNoArrowWithoutContact) {
  settle();
  EXPECT_FALSE(feel().sample().contact);
  EXPECT_EQ(feel().sample().force.norm(), 0);
  EXPECT_EQ(forceShare(), 0);
  EXPECT_GT(toolShare(), 0);
}

TEST_F(MouseFeels, DraggingMovesTheTipUnderThePointerInTheViewPlane) {
  const Vec3 before = view().target();
  dragFromTo(middle(), middle() + QPoint(60, 0));
  const Vec3 moved = view().target() - before;
  const Vec3 eye(view().view().renderer().GetActiveCamera()->GetDirectionOfProjection());
  EXPECT_GT(moved.norm(), 1e-3);
  EXPECT_NEAR(moved.dot(eye), 0, 1e-9);
}

TEST_F(MouseFeels, WheelMovesTheTipInDepthOnly) {
  const Vec3 before = view().target();
  turnWheel(3);
  const Vec3 moved = view().target() - before;
  const Vec3 eye(view().view().renderer().GetActiveCamera()->GetDirectionOfProjection());
  EXPECT_GT(moved.dot(eye), 1e-4);
  EXPECT_NEAR((moved - moved.dot(eye) * eye).norm(), 0, 1e-9);
}

TEST_F(MouseFeels, ShiftMiddleAndRightMoveTheCameraAndNotTheTip) {
  auto* camera = view().view().renderer().GetActiveCamera();
  const Vec3 target = view().target();
  const auto eye = [&] { return Vec3(camera->GetPosition()); };
  Vec3 before = eye();
  dragFromTo(middle(), middle() + QPoint(80, 10), Qt::LeftButton, Qt::ShiftModifier);
  EXPECT_GT((eye() - before).norm(), 1e-3);
  before = eye();
  dragFromTo(middle(), middle() + QPoint(80, 10), Qt::MiddleButton);
  EXPECT_GT((eye() - before).norm(), 1e-3);
  const double distance = camera->GetDistance();
  dragFromTo(middle(), middle() + QPoint(0, -60), Qt::RightButton);
  EXPECT_LT(camera->GetDistance(), distance);
  EXPECT_EQ(view().target(), target);
}

// The test counts the pictures that the window draws by itself.
TEST_F(MouseFeels, DrawsEveryCameraMoveAtOnce) {
  settle();
  int drawn = 0;
  const vtkNew<vtkCallbackCommand> count;
  count->SetClientData(&drawn);
  count->SetCallback(
      [](vtkObject*, unsigned long, void* into, void*) { ++*static_cast<int*>(into); });
  view().renderWindow()->AddObserver(vtkCommand::EndEvent, count);
  const auto isDrawn = [&](const std::function<void()>& move) {
    waitUntil([&] { return view().frames().settled(); }, 5000);
    drawn = 0;
    move();
    return waitUntil([&] { return drawn > 0; }, 500);
  };
  for (const bool feels : {true, false}) {
    trigger(feels ? "tool_feel" : "tool_navigate");
    for (int i = 0; i < 6; ++i) {
      const QPoint to = middle() + QPoint(5, i - 2);
      const auto turn = feels ? Qt::ShiftModifier : Qt::NoModifier;
      EXPECT_TRUE(isDrawn([&] { dragFromTo(middle(), to, Qt::LeftButton, turn); })) << i;
      EXPECT_TRUE(isDrawn([&] { dragFromTo(middle(), to, Qt::MiddleButton); })) << i;
      EXPECT_TRUE(isDrawn([&] { dragFromTo(middle(), middle() + QPoint(0, 4), Qt::RightButton); }));
      if (!feels) {
        EXPECT_TRUE(isDrawn([&] { turnWheel(1); })) << i;
      }
    }
  }
}

TEST_F(MouseFeels, NavigateModeGivesTheLeftButtonToTheCamera) {
  trigger("tool_navigate");
  const Vec3 target = view().target();
  auto* camera = view().view().renderer().GetActiveCamera();
  const Vec3 before(camera->GetPosition());
  dragFromTo(middle(), middle() + QPoint(80, 10));
  turnWheel(2);
  EXPECT_GT((Vec3(camera->GetPosition()) - before).norm(), 1e-3);
  EXPECT_EQ(view().target(), target);
}

TEST_F(MouseFeels, EditsReachTheServoWhileItRuns) {
  send(QEvent::MouseButtonDblClick, middle(), Qt::LeftButton, Qt::LeftButton);
  turnWheel(4);
  settle();
  const double before = feel().sample().force.norm();
  setRow("stiffness", 250);
  ASSERT_TRUE(waitUntil([&] { return edits().scene()->scene.haptics.stiffness == 250; }, 20000));
  settle();
  EXPECT_NEAR(feel().sample().force.norm(), 0.5 * before, 0.05 * before);
}

TEST_F(MouseFeels, LargeEditUnderAPressedTipRampsWithoutFault) {
  send(QEvent::MouseButtonDblClick, middle(), Qt::LeftButton, Qt::LeftButton);
  turnWheel(14);
  settle();
  ASSERT_TRUE(feel().sample().contact);
  startLog();
  setRow("stiffness", 3000);
  setRow("force_limit", 20);
  ASSERT_TRUE(waitUntil([&] { return edits().scene()->scene.haptics.stiffness == 3000; }, 20000));
  wait(200);
  double jump = 0;
  const auto samples = logged();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    ASSERT_FALSE(samples[i].fault);
    jump = std::max(jump, (samples[i].force - samples[i - 1].force).norm());
  }
  EXPECT_GT(samples.back().force.norm(), 3 * samples.front().force.norm());
  EXPECT_LT(jump, 0.2 * samples.back().force.norm());
}

TEST_F(MouseFeels, FrictionHoldsTheProxyBackWhenTheTipMovesSideways) {
  addProperty("Friction");
  setRow("friction_static", 0.8);
  setRow("friction_dynamic", 0.8);
  wait(600);
  send(QEvent::MouseButtonDblClick, middle(), Qt::LeftButton, Qt::LeftButton);
  turnWheel(5);
  settle();
  dragFromTo(middle(), middle() + QPoint(4, 0));
  settle();
  const ToolSample sample = feel().sample();
  ASSERT_TRUE(sample.contact);
  // The line from tip to proxy leans against the motion: the force has a part along the surface.
  const Vec3 along = sample.force - sample.force.dot(sample.normal) * sample.normal;
  EXPECT_GT(along.norm(), 0.05);
}

TEST_F(MouseFeels, LogHoldsEveryTick) {
  startLog();
  wait(400);
  const auto samples = logged();
  ASSERT_GT(samples.size(), 200U);
  for (std::size_t i = 1; i < samples.size(); ++i) ASSERT_GT(samples[i].t, samples[i - 1].t);
}

} // namespace
} // namespace patina
