// While only the tool moves, a window draws it over the picture of the bodies that it has kept: the
// pixels are those of a whole drawing.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkUnsignedCharArray.h>

#include "field/store/surface_field.h"
#include "geometry/mesh/shapes.h"
#include "picture/picture_support.h"
#include "visualization/view/scene_view.h"

namespace patina {
namespace {

constexpr double kTouchedRadius = 0.03; // the ball's [m]

ToolSample tipAt(const Vec3& p) {
  ToolSample sample;
  sample.tip = sample.vcp = sample.surface = p;
  return sample;
}

struct TouchedBall {
  TouchedBall() {
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(640, 480);
    view.setMesh(std::make_shared<TriangleMesh>(icosphere(kTouchedRadius, 24)));
    view.attachTo(*window);
    view.setTipRadius(0.004);
    view.prepare();
    view.fit();
  }
  std::vector<unsigned char> draw() {
    view.prepare();
    window->Render();
    const vtkNew<vtkUnsignedCharArray> pixels;
    window->GetPixelData(0, 0, 639, 479, 0, pixels);
    return {pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues()};
  }
  // The tip before, beside or behind the ball, as the camera sees it.
  void moveTool(double along, double aside) {
    vtkCamera& camera = *view.renderer().GetActiveCamera();
    const Vec3 forward(camera.GetDirectionOfProjection()), up(camera.GetViewUp());
    view.setTool(tipAt(along * forward + aside * up.cross(forward).normalized()));
  }
  vtkNew<vtkRenderWindow> window;
  SceneView view;
};

class KeptPicture : public ::testing::Test {
 protected:
  void SetUp() override { PATINA_NEEDS_DISPLAY(); }
};

TEST_F(KeptPicture, HasThePixelsOfAWholeDrawing) {
  TouchedBall kept;
  kept.moveTool(-0.04, 0);
  (void)kept.draw();
  int frames = 0;
  for (const double along : {-0.04, -0.035, 0., 0.035, -0.03})
    for (const double aside : {-0.03, -0.01, 0.02}) {
      kept.moveTool(along, aside);
      const auto drawn = kept.draw();
      frames += kept.view.keepsBodies();
      TouchedBall whole;
      whole.moveTool(along, aside);
      whole.view.renderer().GetActiveCamera()->DeepCopy(kept.view.renderer().GetActiveCamera());
      const auto expected = whole.draw();
      ASSERT_EQ(drawn.size(), expected.size());
      std::size_t differing = 0;
      for (std::size_t i = 0; i < drawn.size(); ++i)
        differing += std::abs(int(drawn[i]) - int(expected[i])) > 2;
      EXPECT_LT(differing, 30U) << along << " " << aside; // depth rounds in another range
    }
  EXPECT_GT(frames, 10);
}

TEST_F(KeptPicture, IsDroppedWhenTheBodiesOrTheCameraChange) {
  TouchedBall shown;
  for (int i = 0; i < 3; ++i) {
    shown.moveTool(-0.04, 0.001 * i);
    (void)shown.draw();
  }
  EXPECT_TRUE(shown.view.keepsBodies());
  const auto expectDrawn = [&](const char* what) {
    (void)shown.draw();
    EXPECT_FALSE(shown.view.keepsBodies()) << what;
    for (int i = 0; i < 2; ++i) {
      shown.moveTool(-0.04, 0.01 + 0.001 * i);
      (void)shown.draw();
    }
    EXPECT_TRUE(shown.view.keepsBodies()) << what;
  };
  shown.view.renderer().GetActiveCamera()->Azimuth(10);
  expectDrawn("camera");
  shown.view.show(Layer::wireframe, true);
  expectDrawn("layer");
  shown.window->SetSize(640, 470);
  expectDrawn("size");
  shown.view.setMesh(std::make_shared<TriangleMesh>(icosphere(0.5 * kTouchedRadius, 8)));
  expectDrawn("mesh");
}

// The depth of the kept picture is that of the camera's range, which a tip beyond it changes.
TEST_F(KeptPicture, ShowsATipThatLeavesTheRangeOfDepth) {
  TouchedBall shown;
  const auto tool = [&] {
    const auto pixels = shown.draw();
    int found = 0;
    for (std::size_t i = 0; i + 2 < pixels.size(); i += 3)
      found += isTool(Vec3(pixels[i], pixels[i + 1], pixels[i + 2]));
    return found;
  };
  shown.moveTool(-0.04, 0);
  EXPECT_GT(tool(), 50);
  for (int i = 0; i < 3; ++i) {
    shown.moveTool(-0.06 - 0.005 * i, 0);
    EXPECT_GT(tool(), 50) << i;
  }
  shown.moveTool(0.06, 0); // behind the ball
  EXPECT_LT(tool(), 50);
}

// Nothing is drawn again at rest, wherever the tool is.
TEST_F(KeptPicture, IsAtRestWhileTheToolIsBehindTheCamera) {
  TouchedBall shown;
  shown.moveTool(-1, 0);
  (void)shown.draw();
  EXPECT_FALSE(shown.view.prepare());
}

TEST_F(KeptPicture, IsDrawnAnewInAWindowThatHasAnotherSizeSince) {
  TouchedBall shown;
  for (int i = 0; i < 3; ++i) {
    shown.moveTool(-0.04, 0.001 * i);
    (void)shown.draw();
  }
  EXPECT_TRUE(shown.view.keepsBodies());
  shown.window->SetSize(400, 300);
  shown.window->Render(); // the window system redraws before anything is prepared
  EXPECT_FALSE(shown.view.keepsBodies());
  const vtkNew<vtkUnsignedCharArray> pixels;
  shown.window->GetPixelData(0, 0, 399, 299, 0, pixels);
  int surface = 0;
  for (vtkIdType i = 0; i + 2 < pixels->GetNumberOfValues(); i += 3)
    surface +=
        isSurface(Vec3(pixels->GetValue(i), pixels->GetValue(i + 1), pixels->GetValue(i + 2)));
  EXPECT_GT(surface, 10000);
}

} // namespace
} // namespace patina
