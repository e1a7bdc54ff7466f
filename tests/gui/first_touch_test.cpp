// The first drag in a window as it opens is felt, whatever mesh is shown.
#include <algorithm>

#include "app/gui/panels/tool_bar.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "support/changed_mesh.h"

namespace patina {
namespace {

class FirstTouch : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    if (!IsSkipped()) openAnew();
  }
  // A window has the tool that it begins with.
  void openAnew() {
    window_ = std::make_unique<MainWindow>();
    window_->show();
    takeSize(1280, 800);
  }
  // Returns the largest force of a drag over the middle of the picture [N].
  double firstDrag() {
    startLog();
    drag(inView({-30, 10}), inView({30, -10}));
    wait(100);
    double most = 0;
    for (const ToolSample& sample : logged()) most = std::max(most, sample.force.norm());
    return most;
  }
};

TEST_F(FirstTouch, IsFeltOnEveryMesh) {
  const TriangleMesh ball = icosphere(0.03, 20);
  const std::vector<TriangleMesh> meshes = {
      ball,
      torus(0.03, 0.02, 80, 40),
      box(Vec3(0.1, 0.06, 0.08)),
      vase(),
      sheet(0.1, 0.1, 20),
      galleon(0.1),
      box(Vec3(0.1, 0.1, 0.002), 8),
      icosphere(0.005, 12),
      icosphere(2, 20),
      test::moved(ball, Vec3(4.5e3, 5.2e3, 300)),
  };
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (i > 0) openAnew();
    ASSERT_TRUE(open(saved(meshes[i], "mesh" + std::to_string(i) + ".obj")));
    ASSERT_TRUE(waitUntil([&] { return feel().servo().running(); }, 20000));
    wait(200);
    EXPECT_EQ(find<ToolBar>()->choice().handling, InteractionMode::press);
    EXPECT_GT(firstDrag(), 0.1) << "mesh " << i;
  }
}

} // namespace
} // namespace patina
