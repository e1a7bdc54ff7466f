#include "app/gui/widgets/axis_zoom.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patina {
namespace {

constexpr AxisSpan kWhole{-2, 8};

TEST(AxisZoom, WhatIsUnderThePointerStaysThere) {
  const AxisSpan seen{0, 4};
  for (const double notches : {1., 3., -1.}) {
    const AxisSpan nearer = zoomed(kWhole, seen, 1, notches, 0.01);
    EXPECT_NEAR((1 - nearer.from) / nearer.length(), 0.25, 1e-12) << notches;
    EXPECT_NEAR(nearer.length(), 4 * std::pow(1.25, -notches), 1e-12);
  }
}

TEST(AxisZoom, NoMoreThanTheWholeAndNoLessThanTheLeastIsSeen) {
  EXPECT_EQ(zoomed(kWhole, {0, 4}, 1, -50, 0.01), kWhole);
  EXPECT_NEAR(zoomed(kWhole, {0, 4}, 1, 100, 0.01).length(), 0.01, 1e-12);
}

TEST(AxisZoom, AShiftEndsAtTheEndsOfTheWhole) {
  EXPECT_EQ(shifted(kWhole, {0, 4}, 1), (AxisSpan{1, 5}));
  EXPECT_EQ(shifted(kWhole, {0, 4}, 100), (AxisSpan{4, 8}));
  EXPECT_EQ(shifted(kWhole, {0, 4}, -100), (AxisSpan{-2, 2}));
}

} // namespace
} // namespace patina
