#include "app/studies/stability_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

const std::vector<WorkPrecisionTable>& quickTables() {
  static const std::vector<WorkPrecisionTable> tables = [] {
    Progress progress;
    return stabilityStudy(StudyOptions{.quick = true}, progress);
  }();
  return tables;
}

double more(const WorkPrecisionRow& row, const std::string& column) {
  for (const auto& [name, value] : row.more)
    if (name == column) return value;
  return std::nan("");
}

TEST(StabilityStudy, IsRegistered) {
  const auto& all = studies();
  EXPECT_TRUE(
      std::any_of(all.begin(), all.end(), [](const Study& s) { return s.name == "stability"; }));
}

TEST(StabilityStudy, MeasuresTheBoundaryWhereTheEigenvaluesPutIt) {
  const WorkPrecisionTable& table = quickTables().at(0);
  EXPECT_GE(table.rows.size(), 15u);
  for (const WorkPrecisionRow& row : table.rows) {
    EXPECT_LT(row.error, 0.5);
    EXPECT_LT(more(row, "wall s per simulated s"), 0.1);
    EXPECT_GT(row.ns, 0);
  }
}

TEST(StabilityStudy, RestitutionIsOfTheFirstOrderInThePeriod) {
  const WorkPrecisionTable& table = quickTables().at(1);
  ASSERT_TRUE(table.order_fitted && table.order_expected);
  EXPECT_NEAR(*table.order_fitted, *table.order_expected, 0.2);
  for (const WorkPrecisionRow& row : table.rows)
    EXPECT_LT(std::abs(more(row, "mean against formula [%]")), 2);
}

TEST(StabilityStudy, ChatterBeginsAtTwiceTheFrictionOverTheStep) {
  for (const WorkPrecisionRow& row : quickTables().at(2).rows) EXPECT_LT(row.error, 0.1);
}

TEST(StabilityStudy, OnlyTheCouplingRestsAtEveryStiffness) {
  for (const WorkPrecisionRow& row : quickTables().at(3).rows) {
    const std::string& name = row.knobs.at(0).second.asString();
    if (name.starts_with("coupling")) {
      EXPECT_LT(row.error, 1e-9) << name;
    }
    if (name == "plain") {
      EXPECT_GT(row.error, 0.1) << name;
    }
  }
}

TEST(StabilityStudy, AThrownTipIsNotCountedAsSettled) {
  for (const WorkPrecisionRow& row : quickTables().at(3).rows) {
    const std::string& name = row.knobs.at(0).second.asString();
    const bool calms = name.starts_with("coupling");
    if (calms || name == "plain" || name == "naive limiter") {
      EXPECT_EQ(more(row, "settles"), calms ? 1 : 0) << name;
    }
  }
}

} // namespace
} // namespace patina
