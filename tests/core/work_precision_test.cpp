#include "core/work_precision.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/file.h"
#include "core/version.h"

namespace patina {
namespace {

WorkPrecisionTable example() {
  WorkPrecisionTable table;
  table.study = "field";
  table.title = "Distance on a sphere";
  table.error_unit = "m";
  table.rows.push_back({{{"sampler", "kim"}, {"resolution", 50}}, 1.25e-4, 5e-4, 41, 1e6, {}});
  table.rows.push_back(
      {{{"sampler", "high"}, {"resolution", 150}}, 1e-7, 3.0, 48, 2.5e7, {{"cold [ns]", 210}}});
  return table;
}

TEST(FittedOrder, IsExactForAPowerLaw) {
  std::vector<double> h, error;
  for (const double step : {0.1, 0.05, 0.02, 0.01}) {
    h.push_back(step);
    error.push_back(7 * std::pow(step, 2.5));
  }
  EXPECT_NEAR(fittedOrder(h, error), 2.5, 1e-12);
}

TEST(FittedOrder, RejectsDataWithoutASlope) {
  EXPECT_THROW(fittedOrder({0.1}, {1}), std::invalid_argument);
  EXPECT_THROW(fittedOrder({0.1, 0.2}, {1}), std::invalid_argument);
  EXPECT_THROW(fittedOrder({0.1, 0.1}, {1, 2}), std::invalid_argument);
  EXPECT_THROW(fittedOrder({0.1, 0.2}, {0, 2}), std::invalid_argument);
  EXPECT_THROW(fittedOrder({0.1, 0.2}, {NAN, 2}), std::invalid_argument);
}

TEST(WorkPrecision, JsonHasTheDocumentedKeys) {
  const Json json = toJson(example());
  const Json& row = json.at("rows").asArray().at(1);
  EXPECT_EQ(row.at("sampler").asString(), "high");
  EXPECT_EQ(row.at("error").asNumber(), 1e-7);
  EXPECT_EQ(row.at("error_max").asNumber(), 3.0);
  EXPECT_EQ(row.at("ns").asNumber(), 48);
  EXPECT_EQ(row.at("bytes").asNumber(), 2.5e7);
  EXPECT_EQ(row.at("cold [ns]").asNumber(), 210);
  EXPECT_EQ(json.at("program").at("commit").asString(), programCommit());
  EXPECT_TRUE(json.at("order_fitted").isNull());
}

TEST(WorkPrecision, CsvHoldsEveryRowInFullPrecision) {
  WorkPrecisionTable table = example();
  table.rows[0].error = 1.0 / 3;
  table.rows[0].settings[0].second = Json("a, \"b\"");
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "patina_work_precision_test.csv";
  writeCsv(path, table);
  const std::string text = readFile(path);
  std::filesystem::remove(path);
  EXPECT_TRUE(text.starts_with(
      "sampler,resolution,error [m],error_max [m],ns,bytes,cold [ns],program\n\"a, \"\"b\"\"\",50,"
      "0.3333333333333333,"));
  EXPECT_NE(text.find("," + versionText() + "\n"), std::string::npos) << text;
}

TEST(WorkPrecision, DescribesTheMachine) {
  const Json machine = machineDescription();
  for (const char* key : {"processor", "compiler", "flags", "policy", "date"})
    EXPECT_NE(machine.at(key).asString(), "") << key;
  EXPECT_GE(machine.at("cores").asInteger(), 1);
  EXPECT_EQ(machine.at("date").asString().size(), std::string("2000-01-01T00:00:00Z").size());
}

} // namespace
} // namespace patina
