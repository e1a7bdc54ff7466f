// Guidance while a board is photographed: a person who does what the advice says gets a camera.
#include "acquisition/calibration/board_guide.h"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "acquisition/loaded/vision_library.h"
#include "support/first_hour.h"
#include "support/rendered_rig.h"

namespace patina {
namespace {

class GuidedBoard : public testing::Test {
 protected:
  Pose poseAt(const Vec2& pixel, const Vec2& turn, double distance = 0.35) const {
    return test::boardAt(board, camera, pixel, turn, distance);
  }
  GreyFrame picture(const std::vector<Pose>& poses, double blur = 0.6) const {
    FrameLook look = test::boardLook();
    look.blur = blur;
    return renderer.render(poses, look, 3);
  }
  bool show(BoardGuide& guide, const GreyFrame& image) const {
    return addPicture(guide, image, findBoard(image, board), board);
  }

  Board board = parseBoard("charuco:8x5:32mm:24mm:5x5_50");
  Camera camera = test::smallCamera();
  FrameRenderer renderer{camera, test::printedBoard(board)};
  test::DrawnBoard drawn{camera, board};
};

// The pixels' own share is about half a pixel.
TEST_F(GuidedBoard, BlurIsThatOfLensAndMotionInTheWorseDirection) {
  const Pose still = poseAt({320, 240}, {0.1, 0.2});
  for (const double blur : {0.5, 3.0}) {
    const GreyFrame image = picture({still}, blur);
    const double found = blurOf(image, *findBoard(image, board), board);
    std::printf("blur %.1f px, found %.2f px\n", blur, found);
    EXPECT_NEAR(found, std::hypot(blur, 0.5), 0.2 * blur + 0.1);
  }
  std::vector<Pose> moving;
  for (int i = 0; i < 5; ++i) moving.push_back(poseAt({316.0 + 2 * i, 240}, {0, 0}));
  const GreyFrame image = picture(moving);
  EXPECT_GT(blurOf(image, *findBoard(image, board), board), 2);
}

TEST_F(GuidedBoard, WhoFollowsTheAdviceShowsAllOfThePictureAndAllTilts) {
  BoardGuide guide;
  std::vector<BoardView> views;
  Vec2 place(320, 240);
  int pictures = 0;
  for (; !guide.complete && pictures < 40; ++pictures) {
    const auto says = [&](const char* words) {
      return guide.advice.find(words) != std::string::npos;
    };
    Vec2 turn(0, 0);
    const double aside = 3.0 * (pictures % 7); // no hand stands still
    if (says("nearer to")) {
      place.x() = says("left") ? 190 + aside : says("right") ? 450 - aside : 320;
      place.y() = says("upper") ? 140 + aside : says("lower") ? 340 - aside : 240;
    } else if (says("tilt")) {
      place = Vec2(310 + aside, 230 + aside);
      turn = says("left")    ? Vec2(0, -0.45)
             : says("right") ? Vec2(0, 0.45)
             : says("upper") ? Vec2(0.45, 0)
                             : Vec2(-0.45, 0);
    } else if (says("move it on")) {
      place += Vec2(20, -12);
      turn = Vec2(0.1 * (pictures % 5 - 2), 0.1 * (pictures % 3 - 1));
    }
    const GreyFrame image = drawn.draw(poseAt(place, turn), 1);
    const auto view = findBoard(image, board);
    if (addPicture(guide, image, view, board)) views.push_back(*view);
  }
  std::printf("%d pictures, %s\n", pictures, guide.summary().c_str());
  EXPECT_TRUE(guide.complete) << guide.advice << "; " << guide.summary();
  EXPECT_EQ(guide.advice, "done");
  EXPECT_EQ(guide.views.size(), views.size());
  CameraFit fit;
  fit.camera.width = camera.width;
  fit.camera.height = camera.height;
  ASSERT_EQ(visionLibrary().calibrate(views, fit), "");
  std::printf("rms %.3f px, fx %.2f +- %.2f of %.0f\n", fit.rms, fit.camera.fx, fit.deviation[0],
              camera.fx);
  EXPECT_NEAR(fit.camera.fx, camera.fx, 4 * fit.deviation[0] + 0.5);
  EXPECT_LT(fit.deviation[0], 1.5);
}

TEST_F(GuidedBoard, PicturesThatAreBlurredSmallEmptyOrAlikeAreNotUsed) {
  BoardGuide guide;
  const Pose pose = poseAt({320, 240}, {0, 0});
  const GreyFrame sharp = drawn.draw(pose, 1);
  EXPECT_FALSE(show(guide, picture({pose}, 2.5)));
  EXPECT_NE(guide.advice.find("blurred 2."), std::string::npos) << guide.advice;
  EXPECT_FALSE(show(guide, drawn.draw(poseAt({320, 240}, {0, 0}, 1.0), 1)));
  EXPECT_NE(guide.advice.find("closer"), std::string::npos) << guide.advice;
  GreyFrame empty = sharp;
  std::fill(empty.pixel.begin(), empty.pixel.end(), 100);
  EXPECT_FALSE(show(guide, empty));
  EXPECT_NE(guide.advice.find("not found"), std::string::npos) << guide.advice;
  EXPECT_EQ(guide.seenCells() + guide.seenTilts() + guide.views.size(), 0u);
  EXPECT_TRUE(show(guide, sharp));
  EXPECT_FALSE(show(guide, drawn.draw(pose, 2)));
  EXPECT_EQ(guide.views.size(), 1u);
  EXPECT_EQ(guide.seenTilts(), 0u);
}

} // namespace
} // namespace patina
