// A scene that requests the simulated hand gets it, and the surface deflects the hand.
#include "haptics/simulation/simulated_hand.h"

#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

using SimulatedHandWindow = WindowTest;

TEST_F(SimulatedHandWindow, BalancesTheSurfaceIfTheSceneSelectsIt) {
  constexpr double kRadius = 0.03;
  Scene scene = sceneOf(icosphere(kRadius, 30), "sphere");
  scene.device = "simulated";
  saveWorkspace(scene, folder_ / "ws");
  ASSERT_TRUE(open(folder_ / "ws"));
  send(QEvent::MouseButtonDblClick, middle(), Qt::LeftButton, Qt::LeftButton);
  turnWheel(3);
  wait(700);
  const ToolSample sample = feel().sample();
  ASSERT_TRUE(sample.contact);
  const Vec3 pull = HandSpec{}.stiffness * (view().target() - sample.tip);
  ASSERT_LT(pull.norm(), HandSpec{}.max_force);
  EXPECT_GT(pull.norm(), 0.1);
  EXPECT_LT((pull + sample.force).norm(), 0.05 * pull.norm()); // the mouse's tip would have no pull
}

} // namespace
} // namespace patina
