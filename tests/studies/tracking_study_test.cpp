#include "app/studies/framework/studies.h"

#include <gtest/gtest.h>

#include <cmath>

namespace patina {
namespace {

TEST(TrackingStudy, EveryRowHasErrorAndTimeAndFewFramesAreLost) {
  Progress progress;
  const auto tables = trackingStudy(StudyOptions{.quick = true}, progress);
  ASSERT_EQ(tables.size(), 6u);
  for (const WorkPrecisionTable& table : tables)
    for (const WorkPrecisionRow& row : table.rows) {
      EXPECT_TRUE(row.error > 0 && row.error <= row.error_max) << table.title;
      EXPECT_GT(row.ns, 0) << table.title;
      for (const auto& [name, value] : row.more) EXPECT_TRUE(std::isfinite(value)) << name;
    }
  EXPECT_LT(tables[0].rows[0].error, 1) << "mm, at 0.4 m";
  EXPECT_LT(tables[4].rows[1].error, 0.2) << "mm, a tip among outliers";
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_LT(tables[5].rows[i].error_max, 0.15) << "mm, a rig made by hand, calibrated from 60 s";
}

} // namespace
} // namespace patina
