#include "app/studies/framework/studies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/study_rows.h"

namespace patina {
namespace {

using test::knob;
using test::more;
using test::quickTables;

TEST(FrictionStudy, IsRegistered) {
  const auto& all = studies();
  EXPECT_TRUE(
      std::any_of(all.begin(), all.end(), [](const Study& s) { return s.name == "friction"; }));
}

TEST(FrictionStudy, EveryRowHasErrorAndTime) {
  ASSERT_EQ(quickTables<frictionStudy>().size(), 4u);
  for (const WorkPrecisionTable& table : quickTables<frictionStudy>()) {
    EXPECT_GE(table.rows.size(), 6u) << table.title;
    for (const WorkPrecisionRow& row : table.rows) {
      EXPECT_TRUE(std::isfinite(row.error) && row.error <= row.error_max * (1 + 1e-12))
          << table.title;
      EXPECT_GT(row.ns, 0) << table.title;
    }
  }
}

TEST(FrictionStudy, ConvergesAtTheOrdersOfTheory) {
  const double within[] = {0.1, 0.2, 0.02};
  for (std::size_t i = 0; i < 3; ++i) {
    const WorkPrecisionTable& table = quickTables<frictionStudy>()[i];
    ASSERT_TRUE(table.order_fitted && table.order_expected) << table.title;
    EXPECT_NEAR(*table.order_fitted, *table.order_expected, within[i]) << table.title;
  }
}

// T-K09b: within 1 % at 1 kHz.
TEST(FrictionStudy, CycleDissipatesTheClosedFormEnergy) {
  for (const WorkPrecisionRow& row : quickTables<frictionStudy>()[0].rows) {
    EXPECT_LT(row.error_max, 0.2);
    EXPECT_NEAR(more(row, "mean energy [J]") / more(row, "4 mu K d (A - mu d) [J]"), 1, 2e-3);
  }
}

TEST(FrictionStudy, SticksAndSlipsAtTheClosedFormPeriod) {
  for (const WorkPrecisionRow& row : quickTables<frictionStudy>()[1].rows) {
    EXPECT_EQ(more(row, "periods"), 32);
    EXPECT_LT(row.error, 500 / knob(row, "rate [Hz]")); // [%]
    // The surface's spring is a hundred times as stiff as that of the drag.
    EXPECT_NEAR(more(row, "closed form [s]") / more(row, "rigid [s]"), 1, 0.02);
  }
}

// The dragged point of a sampled path lies on a smaller circle: sin(lag) = (rho + s sin(a/2)) / r,
// with rho = mu d, a the rotation of a tick and s the circle's radius.
TEST(FrictionStudy, PublishedSlipLagsLikeAPointOnAString) {
  const double r = 4e-3, rho = 0.4e-3;
  for (const WorkPrecisionRow& row : quickTables<frictionStudy>()[2].rows) {
    const double half = 0.5 * knob(row, "speed [m/s]") / knob(row, "rate [Hz]") / r;
    // |tip|^2 = (s cos)^2 + (rho + s sin)^2, for s.
    const double s =
        -rho * std::sin(half) + std::sqrt(r * r - rho * rho * std::cos(half) * std::cos(half));
    const double lag = std::asin((rho + s * std::sin(half)) / r) * 180 / std::numbers::pi;
    EXPECT_NEAR(more(row, "lag [deg]"), lag, 1e-3 * lag);
  }
}

// The direction lags by some .05 voxel of path for any length of a tick.
TEST(FrictionStudy, DisplacementLagsByTheTrailAlone) {
  const double trail = 0.05 * 0.2e-3, r = 4e-3;
  for (const WorkPrecisionRow& row : quickTables<frictionStudy>()[3].rows)
    EXPECT_LT(row.error_max, 1.51 * trail / r * 180 / std::numbers::pi);
}

} // namespace
} // namespace patina
