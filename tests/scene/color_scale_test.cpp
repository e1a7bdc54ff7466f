// Colour scales as text, as in `patina render --colors` and in a workspace, and their ranges.
#include "scene/color_scale.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/error.h"
#include "scene/scene.h"

namespace patina {
namespace {

TEST(ColorScale, ReadsBackWhatItWrites) {
  const std::string text =
      "viridis,reversed,log,symmetric,bands=8,percentile=2.5,opacity=0.5,digits=3";
  const ColorScale scale = parseColorScale(text);
  EXPECT_EQ(format(scale), text);
  EXPECT_EQ(scale.map, ColorMap::viridis);
  EXPECT_EQ(scale.bands, 8);
  EXPECT_EQ(format(parseColorScale("digits=3,cool-warm")), "cool-warm,digits=3");
  EXPECT_EQ(parseColorScale("none"), ColorScale{});
  EXPECT_EQ(format(ColorScale{}), "");
}

TEST(ColorScale, TakesTheUnitOfAWholeRangeFromItsEnd) {
  const ValueRange both = parseColorScale("range=-2:2mm").range.value();
  EXPECT_DOUBLE_EQ(both.low, -0.002);
  EXPECT_DOUBLE_EQ(both.high, 0.002);
  EXPECT_EQ(parseColorScale("range=500um:1mm").range, (ValueRange{5e-4, 1e-3}));
  EXPECT_EQ(parseColorScale("range=0:2000").range, (ValueRange{0, 2000}));
}

TEST(ColorScale, RefusesWordsThatAreNone) {
  for (const char* bad : {"virids", "bands=1", "bands=2.5", "range=2:1", "range=2", "opacity=2",
                          "percentile=50", "digits=0", "", ","})
    if (*bad != 0) {
      EXPECT_THROW(parseColorScale(bad), Error) << bad;
    }
  ColorScales scales;
  EXPECT_THROW(parseColorScaleOf("sphere=viridis", scales), Error);
  EXPECT_THROW(parseColorScaleOf("slice", scales), Error);
  parseColorScaleOf("friction.static=magma", scales);
  EXPECT_EQ(scaleOf(scales, "friction.static").map, ColorMap::magma);
}

TEST(ColorScale, FindsTheRangeOfItsRule) {
  std::vector<double> values(101);
  std::iota(values.begin(), values.end(), -20.0); // -20 .. 80
  EXPECT_EQ(shownRange({}, {-20, 80}), (ValueRange{-20, 80}));
  EXPECT_EQ(shownRange(parseColorScale("percentile=10"), {-20, 80}, values), (ValueRange{-10, 70}));
  EXPECT_EQ(shownRange(parseColorScale("symmetric"), {-20, 80}), (ValueRange{-80, 80}));
  EXPECT_EQ(shownRange(parseColorScale("range=1:5"), {-20, 80}, values), (ValueRange{1, 5}));
  EXPECT_EQ(shownRange(parseColorScale("log"), {-20, 80}), (ValueRange{0.08, 80}));
}

TEST(ColorScale, IsAValueOfTheScene) {
  Scene scene;
  setValue(scene, "colors.slice", "turbo,range=-0.002:0.002");
  EXPECT_EQ(scaleOf(scene.colors, "slice").map, ColorMap::turbo);
  bool listed = false;
  for (const auto& [key, value] : values(scene))
    listed = listed || (key == "colors.slice" && value == "turbo,range=-0.002:0.002");
  EXPECT_TRUE(listed);
  EXPECT_THROW(setValue(scene, "colors.slice", "blue"), Error);
  setValue(scene, "colors.slice", "none");
  EXPECT_TRUE(scene.colors.empty());
}

TEST(Pins, AreAValueOfTheScene) {
  Scene scene;
  setValue(scene, "pins", "A=0.01,0,-0.03;rim=12mm,1e-3,0");
  ASSERT_EQ(scene.pins.size(), 2U);
  EXPECT_EQ(scene.pins[1], (Pin{"rim", Vec3(0.012, 0.001, 0)}));
  EXPECT_EQ(format(scene.pins), "A=0.01,0,-0.03;rim=0.012,0.001,0");
  EXPECT_EQ(nextPinName(scene.pins), "B");
  for (const char* bad : {"A=1,2", "A", "=1,2,3", "A=1,2,3;A=1,2,4", "a b=1,2,3", "A=1,2,nan"})
    EXPECT_THROW(setValue(scene, "pins", bad), Error) << bad;
  setValue(scene, "pins", "none");
  EXPECT_TRUE(scene.pins.empty());
}

} // namespace
} // namespace patina
