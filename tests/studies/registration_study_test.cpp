#include "app/studies/framework/studies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "acquisition/registration/iterated_closest_points.h"
#include "acquisition/registration/register_path.h"
#include "app/studies/acquisition/registration_cases.h"
#include "field/surface/models.h"
#include "support/least_time.h"
#include "support/study_rows.h"

namespace patina {
namespace {

using test::knob;
using test::more;
using test::quickTables;
using test::word;

// The rows of one setting, by method: ours, the loop, its literal form.
std::vector<std::vector<WorkPrecisionRow>> settings() {
  std::vector<std::vector<WorkPrecisionRow>> all;
  for (const WorkPrecisionRow& row : quickTables<registrationStudy>()[0].rows) {
    if (word(row, "method") == "ours") all.emplace_back();
    all.back().push_back(row);
  }
  return all;
}

TEST(RegistrationStudy, EveryRowHasErrorAndTime) {
  ASSERT_EQ(quickTables<registrationStudy>().size(), 6u);
  EXPECT_EQ(settings().size(), 18u);
  for (const WorkPrecisionTable& table : quickTables<registrationStudy>())
    for (const WorkPrecisionRow& row : table.rows) {
      EXPECT_TRUE(row.error >= 0 && row.error <= row.error_max * (1 + 1e-12)) << table.title;
      EXPECT_GT(row.ns, 0) << table.title;
      for (const auto& [name, value] : row.more) EXPECT_TRUE(std::isfinite(value)) << name;
    }
}

// T-A10d
TEST(RegistrationStudy, FindsThePoseFromFarAwayAndAmongOutliers) {
  for (const auto& rows : settings()) {
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(more(rows[0], "found [%]"), 100)
        << knob(rows[0], "turn [deg]") << " deg, " << knob(rows[0], "outliers [%]") << " %, "
        << knob(rows[0], "noise [mm]") << " mm";
    for (std::size_t i = 1; i < 3 && knob(rows[0], "outliers [%]") > 0; ++i)
      EXPECT_EQ(more(rows[i], "found [%]"), 0);
  }
}

// Both minimise the same least squares, so the loop's result is no better than ours. With noise
// both end within a few faces of the minimum, and these faces determine the pose.
TEST(RegistrationStudy, IsAsAccurateAsTheLoop) {
  for (const auto& rows : settings()) {
    if (knob(rows[0], "outliers [%]") > 0 || knob(rows[0], "turn [deg]") > 15) continue;
    const bool noise = knob(rows[0], "noise [mm]") > 0;
    EXPECT_LE(rows[0].error, (noise ? 1.1 : 1.02) * rows[1].error);
    if (!noise) {
      EXPECT_LT(rows[0].error, 1e-9); // [mm]
      EXPECT_GT(rows[1].error, 1e-6);
    }
  }
}

// Ours also computes errors and unobservable motions. Measured are .40 to .48, .64 to .90 and .80
// to .85; from farther a search may follow.
PATINA_TIMED_TEST(RegistrationStudy, TakesNoLongerThanALoopWithoutErrorBars) {
  const SurfaceTarget target(dinosaur(), 0);
  for (const auto& [noise, most] : {std::pair{0., 0.6}, {0.1e-3, 1.}, {0.5e-3, 1.1}}) {
    std::vector<RegistrationCase> cases;
    for (unsigned seed = 1; seed <= 3; ++seed)
      cases.push_back(drawCase(
          target, {.turn = 5 * std::numbers::pi / 180, .shift = 3e-3, .noise = noise}, seed));
    RegistrationOptions options;
    options.noise = noise;
    const test::Work ours = [&] {
      Progress progress;
      for (const RegistrationCase& given : cases)
        registerPath(target, given.path, given.start, options, progress);
    };
    const test::Work loop = [&] {
      for (const RegistrationCase& given : cases)
        iteratedClosestPoints(target, given.path, given.start, {});
    };
    const auto seconds = test::minSeconds({ours, loop}, 5, 5);
    EXPECT_TRUE(test::within("registered, against the loop", seconds[0], seconds[1], most));
  }
}

// F10: with noise the 4 x 4 matrix shears instead of rotating.
TEST(RegistrationStudy, LiteralMatrixErrsMoreUnderNoise) {
  for (const auto& rows : settings())
    if (knob(rows[0], "noise [mm]") > 0) {
      EXPECT_GT(rows[2].error, 1.5 * rows[1].error);
    }
}

// T-A10b, F11
TEST(RegistrationStudy, GaussNewtonConvergesQuadraticallyAndTheLoopSlowly) {
  EXPECT_NEAR(*quickTables<registrationStudy>()[1].order_fitted, 2, 0.2);
  EXPECT_LT(quickTables<registrationStudy>()[1].rows[2].error,
            1e-6 * quickTables<registrationStudy>()[1].rows[0].error);
  EXPECT_NEAR(*quickTables<registrationStudy>()[2].order_fitted, 1, 0.1);
  for (std::size_t i = 1; i < quickTables<registrationStudy>()[2].rows.size(); ++i) {
    const double left = more(quickTables<registrationStudy>()[2].rows[i], "one more leaves");
    EXPECT_TRUE(left > 0.95 && left < 1) << left;
  }
}

// T-A11d
TEST(RegistrationStudy, ErrorFallsWithTheRootOfTheNumberOfPoints) {
  EXPECT_NEAR(*quickTables<registrationStudy>()[3].order_fitted, -0.5, 0.1);
}

} // namespace
} // namespace patina
