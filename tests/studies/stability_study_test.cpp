#include "app/studies/framework/studies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "support/study_rows.h"

namespace patina {
namespace {

using test::more;
using test::quickTables;

TEST(StabilityStudy, IsRegistered) {
  const auto& all = studies();
  EXPECT_TRUE(
      std::any_of(all.begin(), all.end(), [](const Study& s) { return s.name == "stability"; }));
}

TEST(StabilityStudy, MeasuresTheBoundaryWhereTheEigenvaluesPutIt) {
  const WorkPrecisionTable& table = quickTables<stabilityStudy>().at(0);
  EXPECT_GE(table.rows.size(), 15u);
  for (const WorkPrecisionRow& row : table.rows) {
    EXPECT_LT(row.error, 0.5);
    EXPECT_LT(more(row, "wall s per simulated s"), 0.1);
    EXPECT_GT(row.ns, 0);
  }
}

TEST(StabilityStudy, RestitutionIsOfTheFirstOrderInThePeriod) {
  const WorkPrecisionTable& table = quickTables<stabilityStudy>().at(1);
  ASSERT_TRUE(table.order_fitted && table.order_expected);
  EXPECT_NEAR(*table.order_fitted, *table.order_expected, 0.2);
  for (const WorkPrecisionRow& row : table.rows)
    EXPECT_LT(std::abs(more(row, "mean against formula [%]")), 2);
}

TEST(StabilityStudy, ChatterBeginsAtTwiceTheFrictionOverTheStep) {
  for (const WorkPrecisionRow& row : quickTables<stabilityStudy>().at(2).rows)
    EXPECT_LT(row.error, 0.1);
}

TEST(StabilityStudy, OnlyTheCouplingSettlesAtEveryStiffness) {
  for (const WorkPrecisionRow& row : quickTables<stabilityStudy>().at(3).rows) {
    const std::string& name = row.settings.at(0).second.asString();
    if (name.starts_with("coupling")) {
      EXPECT_LT(row.error, 1e-9) << name;
    }
    if (name == "plain") {
      EXPECT_GT(row.error, 0.1) << name;
    }
  }
}

TEST(StabilityStudy, ThrownTipIsNotCountedAsSettled) {
  for (const WorkPrecisionRow& row : quickTables<stabilityStudy>().at(3).rows) {
    const std::string& name = row.settings.at(0).second.asString();
    const bool calms = name.starts_with("coupling");
    if (calms || name == "plain" || name == "naive limiter") {
      EXPECT_EQ(more(row, "settles"), calms ? 1 : 0) << name;
    }
  }
}

TEST(StabilityStudy, MeasuresTheLimitOnAnySurfaceWhereTheEigenvaluesPutIt) {
  const WorkPrecisionTable& table = quickTables<stabilityStudy>().at(4);
  EXPECT_EQ(table.rows.size(), 5u);
  for (const WorkPrecisionRow& row : table.rows) {
    const std::string& surface = row.settings.at(0).second.asString();
    EXPECT_LT(row.error, surface.starts_with("relief") ? 3 : 0.1) << surface;
    EXPECT_GT(row.ns, 0) << surface;
    EXPECT_LT(more(row, "wall s per simulated s"), 0.1) << surface;
  }
}

TEST(StabilityStudy, RestsAtTheExpectedPointInCornersAndOnRidges) {
  int leaving = 0;
  for (const WorkPrecisionRow& row : quickTables<stabilityStudy>().at(5).rows) {
    const std::string& surface = row.settings.at(0).second.asString();
    EXPECT_EQ(more(row, "fault ticks"), 0) << surface;
    EXPECT_EQ(more(row, "rests"), more(row, "should rest")) << surface;
    leaving += more(row, "touches") == 0;
    const std::string& by = row.settings.at(2).second.asString();
    if (by == "b = K T") {
      EXPECT_NEAR(more(row, "displayed [N/m]") / row.settings.at(1).second.asNumber(), 1, 1e-3)
          << surface;
    }
  }
  EXPECT_EQ(leaving, 2); // the ball and the edge, without any support
}

TEST(StabilityStudy, HasRowsOfReliefAndRoughnessInClosedLoop) {
  std::map<std::string, int> rows;
  for (const WorkPrecisionRow& row : quickTables<stabilityStudy>().at(5).rows) {
    const std::string& surface = row.settings.at(0).second.asString();
    ++rows[surface.substr(0, surface.find(' '))];
    EXPECT_TRUE(std::isfinite(row.error) && row.error < 10) << surface;
    EXPECT_GT(row.ns, 0) << surface;
  }
  EXPECT_EQ(rows["relief"], 4);
  EXPECT_EQ(rows["roughness"], 2);
}

} // namespace
} // namespace patina
