// Round lengths of the scale bar, and legible letters on any ground.
#include <cmath>

#include <gtest/gtest.h>
#include <vtkActor2DCollection.h>
#include <vtkPolyDataMapper2D.h>

#include "visualization/layers/scale_layer.h"
#include "visualization/values/text_style.h"

namespace patina {
namespace {

TEST(ScaleLayer, LengthIsTheLongestRoundOneThatFits) {
  for (double most = 1.7e-7; most < 30; most *= 1.013) {
    const double length = roundLength(most);
    EXPECT_LE(length, most * (1 + 1e-12));
    EXPECT_GT(length, most / 2.5 * (1 - 1e-12)) << most; // the widest step is from 2 to 5
    const double digit = length / std::pow(10, std::floor(std::log10(length) + 1e-9));
    EXPECT_LT(std::min({std::abs(digit - 1), std::abs(digit - 2), std::abs(digit - 5)}), 1e-9);
  }
}

// A view that becomes visible is drawn by its window before it has a size.
TEST(ScaleLayer, CanBeDrawnBeforeThePictureHasAHeight) {
  const vtkNew<vtkRenderer> overlay;
  const vtkNew<vtkCamera> camera;
  ScaleLayer layer(*overlay);
  layer.setVisible(true);
  layer.update(*camera, 0, {});
  vtkActor2DCollection& actors = *overlay->GetActors2D();
  actors.InitTraversal();
  int drawn = 0;
  while (vtkActor2D* actor = actors.GetNextActor2D())
    if (auto* mapper = vtkPolyDataMapper2D::SafeDownCast(actor->GetMapper())) {
      EXPECT_NE(mapper->GetInput(), nullptr);
      ++drawn;
    }
  EXPECT_GT(drawn, 0);
}

TEST(TextStyle, ContrastFollowsWcag) {
  EXPECT_NEAR(contrastOf({0, 0, 0}, {1, 1, 1}), 21, 1e-9);
  EXPECT_NEAR(contrastOf({0.3, 0.6, 0.9}, {0.3, 0.6, 0.9}), 1, 1e-12);
  // #777777 on white is the well-known grey that just fails: 4.48.
  const double grey = 0x77 / 255.;
  EXPECT_NEAR(contrastOf({1, 1, 1}, {grey, grey, grey}), 4.48, 0.005);
}

TEST(TextStyle, MakesEveryColourLegibleAndKeepsItsHueIfPossible) {
  for (const palette::BackgroundStyle& ground : {palette::kLight, palette::kDark}) {
    for (const palette::Color& behind : {ground.low, ground.high, ground.text_background})
      EXPECT_GE(contrastOf(ground.text, behind), 4.5);
    for (double r = 0; r <= 1; r += 0.1)
      for (double g = 0; g <= 1; g += 0.1)
        for (double b = 0; b <= 1; b += 0.1) {
          const palette::Color color{r, g, b}, made = legible(color, ground);
          for (const palette::Color& behind : {ground.low, ground.high, ground.text_background})
            EXPECT_GE(contrastOf(made, behind), 4.5) << r << ' ' << g << ' ' << b;
          if (contrastOf(color, ground.text_background) >= 4.8) {
            EXPECT_EQ(made, color);
          }
        }
  }
}

} // namespace
} // namespace patina
