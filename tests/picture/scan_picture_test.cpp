#include "visualization/view/scan_picture.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <vtkNew.h>
#include <vtkRenderWindow.h>

#include "geometry/mesh/shapes.h"
#include "picture/picture_support.h"
#include "visualization/view/png.h"

namespace patina {
namespace {

// The mesh lies a little deeper than the tip that presses it. Objects near the eye take depth
// resolution from all farther ones, and the ball's back must not show through its front.
TEST(ScanPicture, BallIsSeenFromItsFrontWithObjectsNearTheEye) {
  PATINA_NEEDS_DISPLAY();
  ScanPicture picture;
  picture.setMesh(std::make_shared<const TriangleMesh>(icosphere(0.05, 30)));
  const vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetSize(400, 400);
  picture.attachTo(*window);
  picture.resetCamera(Vec3::UnitZ());
  picture.setMarks({{0, Vec3(0, 0, 2)}, {1, Vec3(2, 2, 2)}, {2, Vec3(-2, -2, -0.1)}});
  picture.prepare();
  window->Render();
  const auto path =
      std::filesystem::path(testing::TempDir()) / ("ball-" + std::to_string(getpid()) + ".png");
  writeWindowPng(*window, path);
  const Pixels pixels(path);
  std::filesystem::remove(path);
  EXPECT_TRUE(isSurface(pixels.at(200, 200)));
  double most = 0; // largest difference from a pixel to the next, well within the disc
  for (int y = 130; y < 270; ++y)
    for (int x = 130; x < 270; ++x)
      most = std::max(most, (pixels.at(x + 1, y) - pixels.at(x, y)).cwiseAbs().maxCoeff());
  EXPECT_LT(most, 12);
}

} // namespace
} // namespace patina
