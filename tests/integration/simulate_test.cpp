// patina simulate: the closed loop from the command line (DESIGN sections 7 and 9).
#include <gtest/gtest.h>

#include "core/csv.h"
#include "integration/program.h"

namespace patina::test {
namespace {

double number(const Json& report, const char* key) {
  return report.at(key).asNumber();
}

TEST(Simulate, ReportsEveryKeyOfTheContract) {
  const Json report = runJson({"simulate", "--plane", "--stiffness", "900"});
  for (const char* key : {"stable", "rms_velocity", "max_depth", "max_force", "energy_absorbed",
                          "energy_credited", "predicted_limit", "rule_of_thumb",
                          "stiffness_displayed", "coupling_stiffness", "restitution"})
    EXPECT_NE(report.find(key), nullptr) << key;
}

// T-SAFE through the command.
TEST(Simulate, RestsAtAnyStiffnessByDefault) {
  for (const char* stiffness : {"900", "1e5", "1e7"})
    for (const char* delay : {"0", "2"}) {
      const Json report = runJson({"simulate", "--plane", "--stiffness", stiffness, "--delay",
                                   delay, "--press", "1", "--start-speed", "0.2"});
      EXPECT_TRUE(report.at("stable").asBool());
      EXPECT_LT(number(report, "rms_velocity"), 1e-9);
      const double coupling = number(report, "coupling_stiffness"), k = std::stod(stiffness);
      EXPECT_NEAR(number(report, "stiffness_displayed") / (k * coupling / (k + coupling)), 1, 1e-3);
    }
}

TEST(Simulate, AVerdictIsAResultAndTheNaiveLimiterIsWorse) {
  const std::vector<std::string> words = {"simulate", "--plane",     "--stiffness",   "3000",
                                          "--press",  "1",           "--start-speed", "0.2",
                                          "--json",   "--stabiliser"};
  const auto with = [&](const char* stabiliser) {
    auto all = words;
    all.push_back(stabiliser);
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.exit, 0);
    return parseJson(outcome.out, "report");
  };
  const Json plain = with("none"), naive = with("naive"), passive = with("passivity");
  EXPECT_FALSE(plain.at("stable").asBool());
  EXPECT_FALSE(naive.at("stable").asBool());
  EXPECT_TRUE(plain.at("coupling_stiffness").isNull());
  EXPECT_NEAR(number(plain, "predicted_limit"), 1000.83, .01);
  EXPECT_GE(number(naive, "rms_velocity"), 3 * number(plain, "rms_velocity"));
  EXPECT_LT(number(passive, "rms_velocity"), 5e-3);
}

TEST(Simulate, WritesOneRowATick) {
  const ScratchFolder folder;
  const std::string path = folder / "run.csv";
  runJson({"simulate", "--plane", "--start-gap", "1mm", "--start-speed", "0.2", "--seconds", "3",
           "-o", path});
  const CsvTable table = readCsv(path, {"t [s]", "x [m]", "y [m]", "z [m]", "vx [m/s]", "vy [m/s]",
                                        "vz [m/s]", "fx [N]", "fy [N]", "fz [N]", "energy [J]"});
  ASSERT_EQ(table.rows.size(), 3000u);
  EXPECT_EQ(table.rows[0][3], 1e-3);
  EXPECT_EQ(table.rows[0][6], -0.2);
  EXPECT_NEAR(table.rows[3][0], 3e-3, 1e-15);
}

TEST(Simulate, MissingStartMeansPressedWithOneNewton) {
  EXPECT_EQ(number(runJson({"simulate", "--plane"}), "press"), 1);
  EXPECT_EQ(number(runJson({"simulate", "--plane", "--start-depth", "1mm"}), "press"), 0);
}

TEST(Simulate, RunsOnAModel) {
  const ScratchFolder folder;
  const std::string mesh = folder / "sphere.ply";
  runJson({"model", "sphere", "-o", mesh});
  const Json report = runJson({"simulate", mesh, "--stiffness", "1e5", "--resolution", "60"});
  EXPECT_TRUE(report.at("stable").asBool());
  EXPECT_LT(number(report, "rms_velocity"), 1e-6); // without friction the top is no place of rest
  const double coupling = number(report, "coupling_stiffness");
  EXPECT_NEAR(number(report, "stiffness_displayed"), 1e5 * coupling / (1e5 + coupling),
              0.01 * coupling);
  EXPECT_EQ(report.at("stages").asArray().at(1).asString(), "coupling");
}

TEST(Simulate, BadValuesAreOneLine) {
  const std::pair<const char*, const char*> bad[] = {
      {"--mass", "0"},          {"--device-damping", "-1"}, {"--delay", "1.5"},
      {"--delay", "21"},        {"--rate", "50"},           {"--encoder-step", "-1"},
      {"--jitter", "2"},        {"--jitter", "2-1ms"},      {"--saturation", "0"},
      {"--press", "nan"},       {"--seconds", "1"},         {"--stabiliser", "magic"},
      {"--stiffness", "1e9"},   {"--hand-mass", "-1"},      {"--start-gap", "1kg"},
      {"--coulomb", "x"},       {"--start-speed", "-1"},    {"--seed", "-1"},
      {"--damping-cutoff", "0"}};
  for (const auto& [option, value] : bad)
    expectOneLineError(run({"simulate", "--plane", option, value}), {option});
  expectOneLineError(run({"simulate"}), {"--plane"});
  expectOneLineError(run({"simulate", "--plane", "--start-gap", "1mm", "--start-depth", "1mm"}),
                     {"--start-gap"});
  expectOneLineError(run({"simulate", "nowhere.ply"}), {"nowhere.ply"});
}

} // namespace
} // namespace patina::test
