// Tables of colour scales: known colours of the maps, reversal, bands, logarithm.
#include "visualization/values/color_table.h"

#include <gtest/gtest.h>

#include <set>

namespace patina {
namespace {

palette::Color at(vtkLookupTable& table, double value) {
  palette::Color color{};
  table.GetColor(value, color.data());
  return color;
}

double away(const palette::Color& a, const palette::Color& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

TEST(ColorTable, HasThePublishedColoursOfItsMaps) {
  // Ends and middle of each map as its authors give them.
  EXPECT_LT(away(mapColor(ColorMap::viridis, 0), {0.267, 0.005, 0.329}), 0.01);
  EXPECT_LT(away(mapColor(ColorMap::viridis, 0.5), {0.128, 0.567, 0.551}), 0.02);
  EXPECT_LT(away(mapColor(ColorMap::viridis, 1), {0.993, 0.906, 0.144}), 0.01);
  EXPECT_LT(away(mapColor(ColorMap::magma, 0.5), {0.716, 0.215, 0.475}), 0.02);
  EXPECT_LT(away(mapColor(ColorMap::magma, 1), {0.987, 0.991, 0.750}), 0.01);
  EXPECT_LT(away(mapColor(ColorMap::greys, 0.25), {0.25, 0.25, 0.25}), 0.005);
  EXPECT_GT(mapColor(ColorMap::cool_warm, 0)[2], mapColor(ColorMap::cool_warm, 0)[0] + 0.3);
  EXPECT_GT(mapColor(ColorMap::cool_warm, 1)[0], mapColor(ColorMap::cool_warm, 1)[2] + 0.3);
}

TEST(ColorTable, ReversesAndBands) {
  ColorScale scale;
  scale.map = ColorMap::viridis;
  const auto plain = colorTable(scale, StandardMap::sequential, {0, 10});
  scale.reversed = true;
  const auto back = colorTable(scale, StandardMap::sequential, {0, 10});
  for (const double v : {0.1, 3.0, 9.9})
    EXPECT_LT(away(at(*plain, v), at(*back, 10 - v)), 0.02) << v;
  scale.bands = 4;
  const auto banded = colorTable(scale, StandardMap::sequential, {0, 10});
  std::set<palette::Color> colors;
  for (int i = 0; i <= 1000; ++i) colors.insert(at(*banded, 0.01 * i));
  EXPECT_EQ(colors.size(), 4U);
  EXPECT_EQ(at(*banded, 0.1), at(*banded, 2.4));
  EXPECT_NE(at(*banded, 2.4), at(*banded, 2.6));
}

TEST(ColorTable, SpreadsDecadesEvenlyInALogarithm) {
  ColorScale scale;
  scale.map = ColorMap::greys;
  scale.logarithmic = true;
  const auto table = colorTable(scale, StandardMap::sequential, {1, 1000});
  EXPECT_NEAR(at(*table, 10)[0], 1 / 3., 0.01);
  EXPECT_NEAR(at(*table, 100)[0], 2 / 3., 0.01);
}

TEST(ColorTable, IsPaleAtZeroOfAnyRangeAsTheStandardOfSignedValues) {
  const auto table = colorTable({}, StandardMap::diverging, {-1, 4});
  const palette::Color zero = at(*table, 0);
  EXPECT_GT(*std::min_element(zero.begin(), zero.end()), 0.8);
  EXPECT_GT(at(*table, -1)[0], at(*table, -1)[2]) << "warm inside";
  EXPECT_GT(at(*table, 4)[2], at(*table, 4)[0]) << "cool outside";
}

} // namespace
} // namespace patina
