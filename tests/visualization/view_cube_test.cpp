#include "visualization/layers/view_cube.h"

#include <gtest/gtest.h>
#include <vtkCamera.h>
#include <vtkNew.h>

namespace patina {
namespace {

std::vector<Vec3> allSides() {
  std::vector<Vec3> sides;
  for (int i = 0; i < 27; ++i)
    if (i != 13) sides.emplace_back(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
  return sides;
}

TEST(ViewCube, IdentifiesEachSideEdgeAndCorner) {
  for (const Vec3& side : allSides()) {
    // A point in the middle of a side, or of an edge's or a corner's part.
    Vec3 on = 0.5 * 0.83 * side;
    int axis = 0;
    side.cwiseAbs().maxCoeff(&axis);
    on[axis] = 0.5 * side[axis]; // on the cube's surface
    const Vec3 eye = on + 3 * side.normalized();
    const auto hit = cubeSideAt({eye, (on - eye).normalized()});
    ASSERT_TRUE(hit.has_value()) << side.transpose();
    EXPECT_EQ(*hit, side) << side.transpose();
  }
}

TEST(ViewCube, IsMissedBesideTheCubeAndBehindTheEye) {
  EXPECT_FALSE(cubeSideAt({Vec3(0.6, 0, 3), -Vec3::UnitZ()}).has_value());
  EXPECT_FALSE(cubeSideAt({Vec3(0, 0, 3), Vec3::UnitZ()}).has_value());
  EXPECT_FALSE(cubeSideAt({Vec3(0, 0, 3), Vec3(0.3, 0, -1).normalized()}).has_value());
}

TEST(TurnOfACamera, EndsUprightOnTheSideAndKeepsFocusAndDistance) {
  for (const Vec3& side : allSides()) {
    const vtkNew<vtkCamera> camera;
    camera->SetFocalPoint(0.1, 0.2, 0.3);
    camera->SetPosition(1, -2, 0.5);
    const double distance = camera->GetDistance();
    setTurn(*camera, turnFrom(side));
    EXPECT_LT((viewDirection(*camera) + side.normalized()).norm(), 1e-12);
    EXPECT_LT((Vec3(camera->GetFocalPoint()) - Vec3(0.1, 0.2, 0.3)).norm(), 1e-12);
    EXPECT_NEAR(camera->GetDistance(), distance, 1e-12);
    const Vec3 up(camera->GetViewUp());
    EXPECT_GT(side.head<2>().norm() > 0 ? up.z() : up.y(), 0.5) << side.transpose();
    EXPECT_LT(turnOf(*camera).angularDistance(turnFrom(side)), 1e-7);
  }
}

TEST(TurnOfACamera, MatchesThePresetsForTheSixSides) {
  const std::pair<ViewPreset, Vec3> sides[] = {
      {ViewPreset::plus_x, Vec3::UnitX()}, {ViewPreset::minus_x, -Vec3::UnitX()},
      {ViewPreset::plus_y, Vec3::UnitY()}, {ViewPreset::minus_y, -Vec3::UnitY()},
      {ViewPreset::plus_z, Vec3::UnitZ()}, {ViewPreset::minus_z, -Vec3::UnitZ()}};
  for (const auto& [preset, side] : sides) {
    const vtkNew<vtkCamera> camera;
    turnCamera(*camera, preset);
    EXPECT_LT(turnOf(*camera).angularDistance(turnFrom(side)), 1e-7) << name(preset);
  }
}

} // namespace
} // namespace patina
