#include "app/studies/acquisition/stroke_trials.h"

#include <cstdio>

#include <gtest/gtest.h>

#include "acquisition/registration_shapes.h"
#include "support/longer.h"

namespace patina {
namespace {

// Returns the mean number of strokes over seeds.
double meanStrokes(const SurfaceTarget& target, StrokeChoice choice, unsigned seeds) {
  double sum = 0;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const StrokeTrial trial = strokesUntilKnown(target, choice, seed);
    EXPECT_LE(trial.error, trialGoal().pose) << seed;
    EXPECT_GE(trial.area, trialGoal().area) << seed;
    sum += static_cast<double>(trial.strokes);
  }
  return sum / seeds;
}

// Each of some 400 strokes is chosen, added and registered, which takes the time.
TEST(StrokeTrials, AdvisedStrokesReachTheGoalSoonerThanRandomOnes) {
  const SurfaceTarget target(test::lumpy(12), 0, true);
  const unsigned seeds = test::isLong() ? 20 : 5;
  const double advised = meanStrokes(target, StrokeChoice::advised, seeds),
               random = meanStrokes(target, StrokeChoice::random, seeds);
  EXPECT_LE(advised, 0.6 * random);
  std::printf("strokes: advised %.1f, random %.1f\n", advised, random);
  if (test::isLong()) {
    const double raster = meanStrokes(target, StrokeChoice::raster, seeds);
    EXPECT_LE(advised, raster);
    std::printf("raster %.1f\n", raster);
  }
}

} // namespace
} // namespace patina
