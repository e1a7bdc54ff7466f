// The cube in the corner of the 3D view, by the pointer.
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>

#include "app/gui/control/view_controller.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "visualization/values/camera.h"

namespace patina {
namespace {

class ViewCubeTest : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 12), "ball.obj")));
  }
  vtkCamera& camera() { return *view().view().renderer().GetActiveCamera(); }
  Vec3 from() { return -viewDirection(camera()); }
  // Returns the centre of a side's visible pixels on the screen, or nothing if the side is hidden.
  std::optional<QPoint> placeOf(const Vec3& side) {
    QPoint sum;
    int count = 0;
    for (int y = view().height() - 150; y < view().height(); ++y)
      for (int x = 0; x < 150; ++x)
        if (view().view().cubeSideAt((x + 0.5) / view().width(), 1 - (y + 0.5) / view().height()) ==
            side)
          sum += QPoint(x, y), ++count;
    if (count == 0) return std::nullopt;
    return view().mapToGlobal(sum / count);
  }
  // Returns the directions to the camera after `act`, one for each change, until the camera looks
  // from the side.
  std::vector<Vec3> turnsOf(const std::function<void()>& act, const Vec3& side) {
    std::vector<Vec3> turns;
    std::function<void()> note = [&] {
      if (const Vec3 now = from(); turns.empty() || now != turns.back()) turns.push_back(now);
    };
    const vtkNew<vtkCallbackCommand> moved;
    moved->SetClientData(&note);
    moved->SetCallback([](vtkObject*, unsigned long, void* act_of, void*) {
      (*static_cast<std::function<void()>*>(act_of))();
    });
    const auto tag = camera().AddObserver(vtkCommand::ModifiedEvent, moved);
    act();
    waitUntil([&] { return looksFrom(side); }, 5000);
    camera().RemoveObserver(tag);
    return turns;
  }
  bool looksFrom(const Vec3& side) { return (from() - side.normalized()).norm() < 1e-9; }
};

TEST_F(ViewCubeTest, ClickTurnsTheViewToTheClickedSideInSmallSteps) {
  if (IsSkipped()) return;
  int in_turns = 0; // sides
  for (const Vec3& side : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, -1, 1)}) {
    trigger("view_iso");
    wait(150); // the cube follows the picture
    const double distance = camera().GetDistance();
    const Vec3 centre(camera().GetFocalPoint()), begun = from();
    const auto place = placeOf(side);
    ASSERT_TRUE(place.has_value()) << side.transpose();
    pointAt(*place);
    EXPECT_EQ(view().cursor().shape(), Qt::PointingHandCursor);
    const std::vector<Vec3> turned = turnsOf([&] { press(), release(); }, side);
    ASSERT_TRUE(looksFrom(side)) << side.transpose() << " " << from().transpose();
    double longest = 0;
    Vec3 last = begun;
    for (const Vec3& seen : turned) {
      longest = std::max(longest, (seen - last).norm());
      last = seen;
    }
    if (turned.size() > 1) in_turns += longest < (begun - side.normalized()).norm();
    EXPECT_LT((Vec3(camera().GetFocalPoint()) - centre).norm(), 1e-9);
    EXPECT_NEAR(camera().GetDistance(), distance, 1e-9);
  }
  // If the machine stood still for the whole animation, only its end is seen.
  EXPECT_GE(in_turns, 1) << "not in one step";
}

TEST_F(ViewCubeTest, DragTurnsAndIsNoClick) {
  if (IsSkipped()) return;
  const auto place = placeOf(Vec3(0, -1, 0));
  ASSERT_TRUE(place.has_value());
  const Vec3 before = from();
  const Vec3 target = view().target();
  drag(*place, *place + QPoint(60, 0));
  const Vec3 turned = from();
  EXPECT_GT((turned - before).norm(), 0.2);
  EXPECT_EQ(view().target(), target) << "the tip stays";
  wait(400);
  EXPECT_EQ(from(), turned);
}

TEST_F(ViewCubeTest, LeftButtonBesideTheCubeBelongsToTheTool) {
  if (IsSkipped()) return;
  const Vec3 before = from(), target = view().target();
  drag(inView({0, 0}), inView({30, 0}));
  EXPECT_EQ(from(), before);
  EXPECT_NE(view().target(), target);
}

} // namespace
} // namespace patina
