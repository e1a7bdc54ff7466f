#include "app/studies/framework/studies.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/study_rows.h"

namespace patina {
namespace {

using test::more;
using test::quickTables;

TEST(DeviceStudy, IsRegistered) {
  EXPECT_TRUE(std::ranges::any_of(studies(), [](const Study& s) { return s.name == "device"; }));
}

TEST(DeviceStudy, EveryRowHasATime) {
  for (const WorkPrecisionTable& table : quickTables<deviceStudy>())
    for (const WorkPrecisionRow& row : table.rows) EXPECT_GT(row.ns, 0) << table.title;
}

TEST(DeviceStudy, EncoderCountIsAboutFortyMicrometresEverywhere) {
  for (const WorkPrecisionRow& row : quickTables<deviceStudy>().at(0).rows) {
    EXPECT_GT(row.error, 2e-5);
    EXPECT_LT(row.error_max, 1.5e-4);
    EXPECT_LT(more(row, "one motor value, most [N]"), 0.02);
  }
}

TEST(DeviceStudy, WallBuzzesWithinATenthOfThePredictionAlsoWithFrictionAndPlay) {
  const WorkPrecisionTable& table = quickTables<deviceStudy>().at(1);
  EXPECT_GE(table.rows.size(), 5U);
  for (const WorkPrecisionRow& row : table.rows)
    EXPECT_LT(row.error, 10) << more(row, "measured [N/m]") << " " << more(row, "predicted [N/m]");
}

TEST(DeviceStudy, EveryStiffnessUpToAHundredThousandSettlesAsStiffAsItsSprings) {
  const WorkPrecisionTable& table = quickTables<deviceStudy>().at(2);
  EXPECT_EQ(test::knob(table.rows.back(), "K [N/m]"), 1e5);
  for (const WorkPrecisionRow& row : table.rows) {
    EXPECT_LT(row.error, 10) << more(row, "displayed [N/m]");
    EXPECT_LT(more(row, "moves [m]"), 1.2e-4); // three counts
  }
}

TEST(DeviceStudy, EveryWireFaultIsDetectedAndNoStalePositionUsed) {
  double injected = 0;
  for (const WorkPrecisionRow& row : quickTables<deviceStudy>().at(3).rows) {
    injected += more(row, "injected");
    EXPECT_EQ(more(row, "unnoticed"), 0);
    EXPECT_EQ(more(row, "old places felt"), 0);
    EXPECT_EQ(more(row, "faults by neither"), 0);
    EXPECT_GT(more(row, "ticks"), 0);
  }
  EXPECT_GT(injected, 0);
}

} // namespace
} // namespace patina
