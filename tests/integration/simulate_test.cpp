// patina simulate: the closed loop from the command line.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/csv.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/shapes.h"
#include "integration/program.h"

namespace patina::test {
namespace {

double number(const Json& report, const char* key) {
  return report.at(key).asNumber();
}

TEST(Simulate, ReportsEveryDocumentedKey) {
  const Json report = runJson({"simulate", "--plane", "--stiffness", "900"});
  for (const char* key : {"stable", "rms_velocity", "max_depth", "max_force", "energy_absorbed",
                          "energy_credited", "predicted_limit", "rule_of_thumb",
                          "stiffness_displayed", "coupling_stiffness", "restitution", "verdict"})
    EXPECT_NE(report.find(key), nullptr) << key;
}

// T-SAFE by the command.
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

TEST(Simulate, ReportsAVerdictAndNaiveLimiterIsWorse) {
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

// K* is 1000.83 N/m without a delay. A far thrown tip is calmer now and then by chance: `stable`
// may be true, but the verdict must not be.
TEST(Simulate, CallsOnlyLoopsWithStableEigenvaluesCalming) {
  struct Case {
    const char *stiffness, *delay;
    std::vector<std::string> verdicts;
  };
  const Case cases[] = {{"300", "0", {"calming down"}},
                        {"990", "0", {"calming down"}},
                        {"1010", "0", {"does not settle"}},
                        {"1100", "0", {"does not settle"}},
                        {"1e4", "0", {"does not settle"}},
                        {"1e6", "0", {"does not settle", "left the surface"}},
                        {"990", "2", {"does not settle"}},
                        {"1100", "2", {"does not settle"}},
                        {"1e6", "2", {"does not settle", "left the surface"}}};
  for (const auto& [stiffness, delay, verdicts] : cases)
    for (const char* speed : {"0", "0.2"}) {
      const Json report =
          runJson({"simulate", "--plane", "--stiffness", stiffness, "--delay", delay, "--press",
                   "1", "--start-speed", speed, "--stabiliser", "none"});
      const std::string verdict = report.at("verdict").asString();
      EXPECT_EQ(std::count(verdicts.begin(), verdicts.end(), verdict), 1)
          << stiffness << " " << delay << " " << speed << ": " << verdict;
    }
}

TEST(Simulate, ReportsThatAnUnpressedTipLeftTheSurface) {
  const Json hit = runJson({"simulate", "--plane", "--stiffness", "400", "--start-speed", "0.2",
                            "--start-gap", "1mm", "--stabiliser", "none"});
  EXPECT_EQ(hit.at("verdict").asString(), "left the surface");
  EXPECT_NEAR(number(hit, "restitution"), 0.93, 0.02);
  const Json inside = runJson({"simulate", "--plane", "--start-depth", "1mm"});
  EXPECT_EQ(inside.at("verdict").asString(), "left the surface");
  const Json waiting = runJson({"simulate", "--plane", "--start-gap", "1mm"});
  EXPECT_EQ(waiting.at("verdict").asString(), "at rest");
}

// A passive surface may return its stored energy of the start, and no more.
TEST(Simulate, DeepStartIsNoEnergyGain) {
  const Json report = runJson({"simulate", "--plane", "--stiffness", "300", "--start-depth", "20mm",
                               "--press", "1", "--stabiliser", "none", "--seconds", "10"});
  EXPECT_EQ(report.at("verdict").asString(), "calming down");
}

TEST(Simulate, RestitutionIsForABounceOrNull) {
  const auto restitution = [](const char* stiffness, const char* delay, const char* speed) {
    return runJson({"simulate", "--plane", "--stiffness", stiffness, "--delay", delay, "--press",
                    "1", "--start-speed", speed, "--stabiliser", "none"})
        .at("restitution");
  };
  EXPECT_TRUE(restitution("1010", "0", "0").isNull());   // -0.43: pressed back before it counts
  EXPECT_TRUE(restitution("1e4", "2", "0").isNull());    // 14.5
  EXPECT_TRUE(restitution("1e6", "2", "0.2").isNull());  // it never returns
  EXPECT_FALSE(restitution("300", "0", "0.2").isNull()); // 0.58
}

TEST(Simulate, ReportsThatATipLeftAndAdvisesOnlyNewOptions) {
  const ScratchFolder folder;
  const std::string mesh = folder / "dinosaur.ply";
  runJson({"model", "dinosaur", "-o", mesh});
  std::vector<std::string> words = {"simulate", mesh, "--resolution", "40", "--stabiliser", "none"};
  const Outcome slid = run(words);
  EXPECT_EQ(slid.exit, 0);
  EXPECT_NE(slid.out.find("left the surface"), std::string::npos) << slid.out;
  EXPECT_NE(slid.err.find("--hand-stiffness"), std::string::npos) << slid.err;
  words.insert(words.end(), {"--hand-stiffness", "0.01"});
  const Outcome held = run(words);
  EXPECT_NE(held.out.find("left the surface"), std::string::npos) << held.out;
  EXPECT_EQ(held.err.find("--hand-stiffness"), std::string::npos) << held.err;
}

TEST(Simulate, NamesARemedyForAnUnpressedTip) {
  const ScratchFolder folder;
  const std::string mesh = folder / "sphere.ply";
  runJson({"model", "sphere", "-o", mesh});
  const std::vector<std::string> on_model = {"simulate", mesh, "--resolution", "40"};
  for (std::vector<std::string> words : {on_model, {"simulate", "--plane"}}) {
    words.insert(words.end(), {"--start-depth", "1mm"});
    const Outcome left = run(words);
    EXPECT_NE(left.out.find("left the surface"), std::string::npos) << left.out;
    EXPECT_NE(left.err.find("--hand-stiffness"), std::string::npos) << left.err;
    EXPECT_NE(left.err.find("--press"), std::string::npos) << left.err;
  }
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
  EXPECT_LT(number(report, "rms_velocity"), 1e-6); // the top without friction is no place of rest
  const double coupling = number(report, "coupling_stiffness");
  EXPECT_NEAR(number(report, "stiffness_displayed"), 1e5 * coupling / (1e5 + coupling),
              0.01 * coupling);
  EXPECT_EQ(report.at("stages").asArray().at(1).asString(), "coupling");
}

TEST(Simulate, RunsOnASheetTouchedFromBothSides) {
  const ScratchFolder folder;
  const std::string mesh = folder / "sheet.ply";
  writeMesh(mesh, sheet(0.1, 0.1, 10));
  for (const char* radius : {"0.5mm", "2mm"}) {
    const std::string scene = folder / (std::string("scene") + radius);
    ASSERT_EQ(run({"scene", "-o", scene, "--add", mesh, "--unit", "m", "--set",
                   std::string("tip.radius=") + radius, "--set", "surface.sides=two", "--set",
                   "stiffness=800"})
                  .exit,
              0);
    const Json report = runJson({"simulate", scene});
    EXPECT_TRUE(report.at("stable").asBool()) << radius;
    // A press of 1 N holds it, by the spring and the coupling in series; a sudden press moves it
    // down by twice that at most.
    const double rest = 1 / number(report, "stiffness_displayed");
    EXPECT_GT(number(report, "max_depth"), rest - 2e-4) << radius;
    EXPECT_LT(number(report, "max_depth"), 2 * rest) << radius;
  }
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
  expectOneLineError(run({"simulate", "plate.ply", "--plane"}), {"plate.ply", "not both"});
  expectOneLineError(run({"simulate", "--plane", "--stabiliser", "foo"}),
                     {"--stabiliser", "'foo'", "auto", "naive"});
  expectOneLineError(run({"simulate", "--plane", "--start-gap", "1mm", "--start-depth", "1mm"}),
                     {"--start-gap"});
  expectOneLineError(run({"simulate", "nowhere.ply"}), {"nowhere.ply"});
}

} // namespace
} // namespace patina::test
