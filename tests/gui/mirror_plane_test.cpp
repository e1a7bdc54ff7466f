// The plane of a mirrored brush: its position, and when it is visible.
#include "app/gui/painting/mirror_plane.h"

#include <QComboBox>

#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"

namespace patina {
namespace {

TEST(MirrorPlane, LiesAtTheBoxCentreAcrossTheObjectsAxis) {
  SceneObject object{.name = "box", .mesh = {}};
  auto mesh = std::make_shared<TriangleMesh>(icosphere(0.03, 4));
  for (Vec3& point : mesh->positions) point += Vec3(0.1, 0.2, 0.3);
  object.mesh = mesh;
  object.world_from_object =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized());
  const Symmetry all[] = {Symmetry::x, Symmetry::y, Symmetry::z};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 sum = Vec3::Zero();
    double reach = 0;
    for (const Vec3& corner : mirrorPlane(object, all[axis])) {
      const Vec3 own = object.world_from_object.inverse() * corner - Vec3(0.1, 0.2, 0.3);
      EXPECT_NEAR(own[axis], 0, 2e-3) << "an icosphere's box is not its sphere's to the last bit";
      sum += own / 4;
      reach = std::max(reach, own.norm());
    }
    EXPECT_LT(sum.norm(), 2e-3);
    EXPECT_GT(reach, 0.03 * std::sqrt(2)) << "it comes out of the object";
  }
}

TEST_F(DrivenWindow, ShowsTheMirrorPlaneWhilePaintingWithIt) {
  if (IsSkipped()) return;
  ASSERT_TRUE(open(saved(icosphere(0.03, 12), "ball.obj")));
  trigger("tool_color");
  const auto blue = [&] {
    wait(200);
    return share([](int r, int g, int b) { return b > r + 32 && g > r + 8; });
  };
  const double without = blue();
  auto* mirrored = find<QComboBox>("brush_symmetry");
  mirrored->setFocus();
  type(0xff54); // down
  ASSERT_EQ(mirrored->currentIndex(), 1);
  EXPECT_GT(blue(), without + 0.005);
  view().setFocus();
  type('v');
  EXPECT_NEAR(blue(), without, 0.002) << "nothing is painted";
}

} // namespace
} // namespace patina
