// The strokes of a path over a mesh.
#include "acquisition/texture/path_strokes.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace patina {
namespace {

std::vector<TimedPoint> pointsAt(const std::vector<double>& times) {
  std::vector<TimedPoint> points;
  for (const double t : times) points.push_back({t, Vec3(t, 0, 0)});
  return points;
}

TEST(PathStrokes, BeginAfterALongPause) {
  const auto strokes = strokesOf(pointsAt({0, 1, 2, 3, 20, 21, 22}), {});
  ASSERT_EQ(strokes.size(), 2U);
  EXPECT_EQ(strokes[0].points.size(), 4U);
  EXPECT_TRUE(strokes[0].arc_length.empty());
}

// Samples that a registration rejects are a pause and do not end a stroke.
TEST(PathStrokes, CoverKnownIntervalsTheLongestFirst) {
  IntervalPositions places;
  for (int i = 0; i < 3; ++i) places[i] = {0.001 * i, 0};
  for (int i = 10; i < 60; ++i) places[i] = {0.001 * (i - 10), 1};
  places[60] = places[59]; // the probe rested
  std::vector<double> times;
  for (int i = 0; i < 62; ++i)
    if (i < 20 || i > 40) times.push_back(i);
  const auto strokes = strokesOf(pointsAt(times), places);
  ASSERT_EQ(strokes.size(), 2U);
  EXPECT_EQ(strokes[0].points.size(), 29U);
  EXPECT_EQ(strokes[0].arc_length.back(), 0.049);
  EXPECT_EQ(strokes[1].points.size(), 3U);
}

TEST(PathStrokes, RejectDecreasingArcLengthAndHeightsOfAnotherScan) {
  EXPECT_THROW(strokesOf(pointsAt({0, 1}), {{0., {0.1, 0}}, {1., {0, 0}}}), Error);
  EXPECT_THROW(strokesOf(pointsAt({0, 1}), {{5., {0.1, 0}}}), Error);
}

} // namespace
} // namespace patina
