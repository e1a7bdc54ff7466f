#include <cmath>

#include <gtest/gtest.h>

#include "app/studies/framework/studies.h"

namespace patina {
namespace {

TEST(ScanStudy, CalibrationOfARigMadeByHandBringsTheFeltForceNearer) {
  Progress progress;
  const auto tables = scanStudy(StudyOptions{.quick = true}, progress);
  ASSERT_EQ(tables.size(), 1u);
  ASSERT_EQ(tables[0].rows.size(), 2u);
  for (const WorkPrecisionRow& row : tables[0].rows) {
    EXPECT_TRUE(row.error > 0 && row.error <= row.error_max);
    EXPECT_GT(row.ns, 0);
    for (const auto& [name, value] : row.more) {
      EXPECT_TRUE(std::isfinite(value)) << name;
      std::printf("%s %.4g  ", name.c_str(), value);
    }
    std::printf("felt %.3g %%\n", row.error);
  }
  const auto path = [&](std::size_t row) { return tables[0].rows[row].more[0].second; };
  EXPECT_LT(path(1), 0.5 * path(0)) << "mm, calibrated against as printed";
}

} // namespace
} // namespace patina
