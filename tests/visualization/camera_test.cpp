#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <vtkMatrix4x4.h>
#include <vtkNew.h>

#include "core/error.h"
#include "visualization/values/camera.h"

namespace patina {
namespace {

std::vector<Vec3> cloud() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < 400; ++i)
    points.emplace_back(0.05 * unit(random), 0.02 * unit(random) + 0.3, 0.03 * unit(random));
  return points;
}

// Returns a point's position in the picture: fractions of the height from the centre.
Vec2 projected(vtkCamera& camera, const Vec3& point) {
  const Ray centre = rayThrough(camera, 0, 0);
  const Vec3 right = centre.direction.cross(Vec3(camera.GetViewUp())).normalized();
  const Vec3 up = right.cross(centre.direction);
  const Vec3 to = point - centre.origin;
  const double high = 2 * to.dot(centre.direction) * std::tan(camera.GetViewAngle() * M_PI / 360);
  return {to.dot(right) / high, to.dot(up) / high};
}

TEST(Camera, FitsEveryPointTightlyFromEverySide) {
  for (const ViewPreset view : allViews())
    for (const double aspect : {0.5, 1.0, 2.0}) {
      const vtkNew<vtkCamera> camera;
      turnCamera(*camera, view);
      resetCameraTo(*camera, Vec3(0, 0.3, 0), cloud(), aspect);
      double fullest = 0;
      for (const Vec3& point : cloud()) {
        const Vec2 at = projected(*camera, point);
        fullest = std::max({fullest, std::abs(at[0]) / (0.5 * aspect), std::abs(at[1]) / 0.5});
      }
      EXPECT_LE(fullest, 1.0) << name(view) << aspect;
      EXPECT_GT(fullest, 0.85) << name(view) << aspect;
    }
}

TEST(Camera, PresetsLookAlongTheirAxis) {
  const vtkNew<vtkCamera> camera;
  turnCamera(*camera, ViewPreset::plus_x);
  EXPECT_NEAR((viewDirection(*camera) + Vec3::UnitX()).norm(), 0, 1e-12);
  turnCamera(*camera, ViewPreset::minus_z);
  EXPECT_NEAR((viewDirection(*camera) - Vec3::UnitZ()).norm(), 0, 1e-12);
}

// T-A09: top, bottom, front and back without perspective; each corner of a box is at the position
// that a viewer from there expects.
TEST(Camera, FourViewsShowACornerAtItsPlace) {
  struct View {
    ViewPreset preset;
    Vec3 right, up;
  };
  for (const View& view : {View{ViewPreset::plus_z, Vec3::UnitX(), Vec3::UnitY()},
                           View{ViewPreset::minus_z, -Vec3::UnitX(), Vec3::UnitY()},
                           View{ViewPreset::minus_y, Vec3::UnitX(), Vec3::UnitZ()},
                           View{ViewPreset::plus_y, -Vec3::UnitX(), Vec3::UnitZ()}}) {
    const vtkNew<vtkCamera> camera;
    turnCamera(*camera, view.preset);
    setParallel(*camera, true);
    const vtkMatrix4x4& matrix = *camera->GetViewTransformMatrix();
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner(i & 1 ? 3 : -1, i & 2 ? 2 : -2, i & 4 ? 1 : -4);
      Vec3 seen;
      for (int row = 0; row < 3; ++row) {
        seen[row] = matrix.GetElement(row, 3);
        for (int k = 0; k < 3; ++k) seen[row] += matrix.GetElement(row, k) * corner[k];
      }
      const Vec3 middle(matrix.GetElement(0, 3), matrix.GetElement(1, 3), 0);
      EXPECT_NEAR(seen.x() - middle.x(), corner.dot(view.right), 1e-12) << name(view.preset);
      EXPECT_NEAR(seen.y() - middle.y(), corner.dot(view.up), 1e-12) << name(view.preset);
    }
  }
}

TEST(Camera, ProjectsAPointInTheViewPlaneBackToItsPlace) {
  const vtkNew<vtkCamera> camera;
  turnCamera(*camera, ViewPreset::iso);
  resetCameraTo(*camera, Vec3(0, 0.3, 0), cloud(), 1.5);
  const Vec3 through(0.01, 0.31, -0.02);
  const Vec3 point = pointInViewPlane(*camera, 0.21, -0.34, through);
  EXPECT_NEAR((projected(*camera, point) - Vec2(0.21, -0.34)).norm(), 0, 1e-12);
  EXPECT_NEAR((point - through).dot(viewDirection(*camera)), 0, 1e-12);
}

// The reference is VTK's own projection.
TEST(Camera, RaysAreParallelAndHitThePicturesPointWithoutPerspective) {
  const vtkNew<vtkCamera> camera;
  turnCamera(*camera, ViewPreset::iso);
  resetCameraTo(*camera, Vec3(0, 0.3, 0), cloud(), 1.5);
  setParallel(*camera, true);
  zoom(*camera, 1.7);
  pan(*camera, 0.1, -0.05);
  auto* to_picture = camera->GetCompositeProjectionTransformMatrix(1.5, -1, 1);
  for (const Vec3& point : cloud()) {
    double seen[4] = {point[0], point[1], point[2], 1};
    to_picture->MultiplyPoint(seen, seen);
    const Ray ray = rayThrough(*camera, 0.5 * 1.5 * seen[0], 0.5 * seen[1]);
    const Vec3 off = point - ray.origin;
    EXPECT_NEAR((off - off.dot(ray.direction) * ray.direction).norm(), 0, 1e-9);
    EXPECT_NEAR((ray.direction - viewDirection(*camera)).norm(), 0, 1e-12);
  }
}

TEST(Camera, FocusedObjectKeepsItsSizeWithoutPerspective) {
  const vtkNew<vtkCamera> camera;
  resetCameraTo(*camera, Vec3(0, 0.3, 0), cloud(), 1.5);
  zoom(*camera, 1.3);
  const Vec3 at(camera->GetFocalPoint());
  const Vec3 edge = pointInViewPlane(*camera, 0.3, 0.4, at);
  setParallel(*camera, true);
  EXPECT_NEAR((pointInViewPlane(*camera, 0.3, 0.4, at) - edge).norm(), 0, 1e-12);
}

TEST(Camera, OrbitKeepsTheDistanceAndPanMovesWithThePointer) {
  const vtkNew<vtkCamera> camera;
  turnCamera(*camera, ViewPreset::iso);
  resetCameraTo(*camera, Vec3(0, 0.3, 0), cloud(), 1.5);
  const double distance = camera->GetDistance();
  orbit(*camera, 0.2, 0.1);
  EXPECT_NEAR(camera->GetDistance(), distance, 1e-9);
  const Vec3 focus(camera->GetFocalPoint());
  pan(*camera, 0.1, -0.05);
  EXPECT_NEAR((projected(*camera, focus) - Vec2(0.1, -0.05)).norm(), 0, 1e-9);
  zoom(*camera, 2);
  EXPECT_NEAR(camera->GetDistance(), distance / 2, 1e-9);
}

TEST(ViewOptions, ReadBackTheirWordsAndListTheChoicesForUnknownOnes) {
  for (const Layer layer : allLayers()) EXPECT_EQ(parseLayers(name(layer)), std::set<Layer>{layer});
  for (const ViewPreset view : allViews()) EXPECT_EQ(parseView(name(view)), view);
  EXPECT_EQ(parseLayers("mesh,slice,band").size(), 3U);
  for (const char* bad : {"", "mesh,", "Mesh", "mesh slice"}) {
    try {
      parseLayers(bad);
      ADD_FAILURE() << bad;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("wireframe"), std::string::npos);
    }
  }
  EXPECT_THROW(parseView("front"), Error);
}

// The reference is the rotation and the shift of the object itself, seen by a fixed camera.
TEST(Camera, MovesTheObjectLikeInTheHand) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 50; ++round) {
    const vtkNew<vtkCamera> camera;
    turnCamera(*camera, ViewPreset::iso);
    resetCameraTo(*camera, Vec3(0, 0.3, 0), cloud(), 1);
    const Vec3 focus(camera->GetFocalPoint());
    const Vec3 back = -viewDirection(*camera), up(camera->GetViewUp()), right = up.cross(back);
    Eigen::Matrix3d axes;
    axes << right, up, back;
    const Vec3 turn = 1e-4 * Vec3(unit(random), unit(random), unit(random));
    const Vec3 shift = 1e-4 * Vec3(unit(random), unit(random), 0);
    const double high = 2 * camera->GetDistance() * std::tan(camera->GetViewAngle() * M_PI / 360);
    const vtkNew<vtkCamera> still;
    still->DeepCopy(camera);
    moveInObjectMode(*camera, shift, turn);
    for (const Vec3& point : cloud()) {
      const Vec3 arm = point - focus;
      const Vec3 moved = point + (axes * turn).cross(arm) + high * (axes * shift);
      EXPECT_LT((projected(*camera, point) - projected(*still, moved)).norm(), 1e-7);
    }
  }
}

} // namespace
} // namespace patina
