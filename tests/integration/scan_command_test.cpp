// A scan from its simulation to the path: the folder's files, the report, what is refused.
#ifdef PATINA_HAS_ACQUISITION
#include <gtest/gtest.h>

#include <cmath>

#include "core/csv.h"
#include "core/file.h"
#include "integration/program.h"

namespace patina::test {
namespace {

class Scans : public testing::Test {
 protected:
  void SetUp() override {
    ball = folder / "ball.ply";
    ASSERT_EQ(run({"model", "sphere", "-o", ball}).exit, 0);
    scan = folder / "scan";
    path = folder / "path.csv";
  }
  Json simulate(std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"simulate-scan", ball, "-o", scan};
    words.insert(words.end(), more.begin(), more.end());
    return runJson(words);
  }
  void refused(const std::string& file, const std::string& text,
               const std::vector<std::string>& parts) const {
    const std::string kept = readFile(scan + "/" + file);
    writeFileAtomically(scan + "/" + file, text);
    expectOneLineError(run({"filter", scan, "-o", path}), parts);
    EXPECT_FALSE(std::filesystem::exists(path));
    writeFileAtomically(scan + "/" + file, kept);
  }

  ScratchFolder folder;
  std::string ball, scan, path;
};

TEST_F(Scans, RunFromSimulationToPath) {
  const Json made = simulate();
  for (const Json& file : made.at("files").asArray())
    EXPECT_TRUE(std::filesystem::exists(scan + "/" + file.asString())) << file.asString();
  const Json report = runJson({"filter", scan, "-o", path});
  EXPECT_EQ(report.at("model").asString(), "fused");
  EXPECT_GT(report.at("samples").asInteger(), 4000);
  EXPECT_LT(report.at("error").at("rms").asNumber(), 0.4e-3);
  EXPECT_NEAR(report.at("error").at("nees").asNumber(), 1, 0.5);
  EXPECT_NEAR(report.at("nis_mean").asNumber(), 1, 0.2);
  EXPECT_LT(report.at("rejected").asInteger(), 10);
  EXPECT_GT(report.at("rms_innovation").asNumber(), 0);
  EXPECT_GT(report.at("seconds").asNumber(), 0);
  EXPECT_TRUE(report.at("gaps").asArray().empty());
  const CsvTable rows = readCsv(
      path, {"t [s]", "x [m]", "y [m]", "z [m]", "qx", "qy", "qz", "qw", "sigma [m]", "force [N]"});
  ASSERT_EQ(static_cast<std::int64_t>(rows.rows.size()), report.at("samples").asInteger());
  for (const auto& row : rows.rows) {
    EXPECT_GT(row[8], 0);
    EXPECT_GT(row[9], 0) << "only what touches is path";
  }
}

TEST_F(Scans, TellWhereTheMeshIs) {
  for (const char* from : {"+z", "-z", "+y"}) {
    simulate({"--from", from, "--roughness", "0"});
    const Json::Array rows =
        parseJson(readFile(scan + "/truth.json"), "truth").at("mesh_from_camera").asArray();
    double touching = 0;
    for (const auto& sample :
         readCsv(scan + "/truth.csv", {"t [s]", "x [m]", "y [m]", "z [m]"}).rows) {
      if (!(sample[9] > 0)) continue;
      double square = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        double place = rows[i].asArray()[3].asNumber();
        for (std::size_t k = 0; k < 3; ++k)
          place += rows[i].asArray()[k].asNumber() * sample[k + 1];
        square += place * place;
      }
      ASSERT_NEAR(std::sqrt(square), 0.05, 0.6e-3) << from; // of the ball; it yields
      touching += 1;
    }
    EXPECT_GT(touching, 1000);
  }
}

TEST_F(Scans, AreTheSameForTheSameWords) {
  simulate();
  const std::string first = readFile(scan + "/probe.csv") + readFile(scan + "/poses.tum");
  simulate();
  EXPECT_TRUE(first == readFile(scan + "/probe.csv") + readFile(scan + "/poses.tum"));
  simulate({"--seed", "2"});
  EXPECT_FALSE(first == readFile(scan + "/probe.csv") + readFile(scan + "/poses.tum"));
}

TEST_F(Scans, GiveHeightsWhereTheyAreAskedFor) {
  ASSERT_EQ(run({"model", "plate", "-o", ball}).exit, 0);
  simulate({"--roughness", "50um"});
  const std::string heights = folder / "heights.csv";
  const Json report = runJson({"filter", scan, "-o", path, "--heights", heights});
  const CsvTable rows =
      readCsv(heights, {"t [s]", "along [m]", "height [m]", "sigma [m]", "stretch"});
  EXPECT_GT(rows.rows.size(), 4000u);
  EXPECT_EQ(report.at("stretches").asNumber(), rows.rows.back()[4] + 1);
  EXPECT_GT(report.at("stiffness").at("presses").asInteger(), 2);
  const Json other =
      runJson({"filter", scan, "-o", path, "--heights", heights, "--normal", "0,-0.53,-0.85"});
  EXPECT_NEAR(other.at("normal").asArray()[1].asNumber(),
              report.at("normal").asArray()[1].asNumber(), 0.01);
  std::filesystem::remove(path);
  std::filesystem::remove(heights);
  const auto refused = [&](std::vector<std::string> more, const std::string& part) {
    more.insert(more.begin(), {"filter", scan, "-o", path});
    expectOneLineError(run(more), {part});
    EXPECT_FALSE(std::filesystem::exists(path) || std::filesystem::exists(heights));
  };
  refused({"--normal", "0,0,1"}, "--normal");
  refused({"--heights", heights, "--normal", "0,0,0"}, "--normal");
  refused({"--heights", heights, "--model", "acceleration"}, "--heights");
  refused({"--heights", path}, "path.csv");
}

TEST_F(Scans, WithFaultsTellThem) {
  simulate({"--dropouts", "3", "--outliers", "0.03", "--clock-offset", "0.1", "--from", "-x"});
  const Outcome text = run({"filter", scan, "-o", path});
  EXPECT_EQ(text.exit, 0);
  EXPECT_NE(text.err.find("poses.tum:"), std::string::npos) << text.err;
  EXPECT_NE(text.err.find("without a pose, the longest of 3 gaps"), std::string::npos) << text.err;
  const Json report = runJson({"filter", scan, "-o", path});
  EXPECT_EQ(report.at("gaps").asArray().size(), 3u);
  EXPECT_GT(report.at("rejected").asInteger(), 10);
  EXPECT_NEAR(report.at("clock_offset").asNumber(), 0.1, 2e-3);
  EXPECT_LT(report.at("error").at("rms").asNumber(), 0.6e-3);
}

TEST_F(Scans, ArePosesAloneToo) {
  simulate();
  const std::string poses = scan + "/poses.tum";
  const Json alone = runJson({"filter", poses, "-o", path, "--truth", scan + "/truth.csv"});
  EXPECT_EQ(alone.at("model").asString(), "acceleration");
  const Json with = runJson({"filter", poses, "--probe", scan + "/probe.csv", "-o", path, "--truth",
                             scan + "/truth.csv", "--smooth"});
  EXPECT_EQ(with.at("model").asString(), "fused");
  EXPECT_LT(with.at("error").at("rms").asNumber(), alone.at("error").at("rms").asNumber());
  const Json forward =
      runJson({"filter", scan, "-o", path, "--forward", "--model", "velocity", "--lifted"});
  EXPECT_GT(forward.at("error").at("rms").asNumber(), alone.at("error").at("rms").asNumber());
  expectOneLineError(run({"filter", scan, "-o", path, "--forward", "--model", "fused"}),
                     {"--forward"});
  expectOneLineError(run({"filter", poses, "-o", path, "--model", "fused"}), {"--probe"});
}

TEST_F(Scans, ThatAreDamagedAreRefusedWithFileAndLine) {
  simulate();
  const std::string poses = readFile(scan + "/poses.tum"), probe = readFile(scan + "/probe.csv");
  const std::string head = probe.substr(0, probe.find('\n') + 1);
  refused("poses.tum", "", {"poses.tum", "no pose"});
  refused("poses.tum", poses + "0 0 0 0 0 0 0 1\n", {"poses.tum:", "backwards"});
  refused("poses.tum", "0 0,5 0 0 0 0 0 1\n", {"poses.tum:1:", "decimal commas"});
  refused("poses.tum", "0 nan 0 0 0 0 0 1\n", {"poses.tum:1:", "nan"});
  refused("poses.tum", "1000 0 0 0 0 0 0 1\n1001 0 0 0 0 0 0 1\n", {"no time in common"});
  refused("probe.csv", "", {"probe.csv", "empty"});
  refused("probe.csv", head, {"probe.csv", "no sample"});
  refused("probe.csv", probe + "0,0,0,0,0,0\n", {"probe.csv:", "backwards"});
  refused("probe.csv", head + "0,0,0,nan,0,0\n", {"probe.csv:2:", "a1v"});
  refused("probe.csv", head + "0,1;0;0;0;0;0\n", {"probe.csv:2:", "decimal commas"});
  refused("rig.json", "{", {"rig.json"});
  refused("rig.json", "{\"tip\": 3}", {"rig.json", "tip"});
  std::filesystem::remove(scan + "/poses.tum");
  expectOneLineError(run({"filter", scan, "-o", path}), {"poses.tum"});
  expectOneLineError(run({"filter", folder / "none.tum", "-o", path}), {"none.tum"});
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(Scans, OfNothingToScanAreRefused) {
  const std::string plate = folder.write("wall.obj", "v 0 0 0\nv 100 0 0\nv 0 0.1 100\nf 1 2 3\n");
  expectOneLineError(run({"simulate-scan", plate, "-o", scan}), {"--from"});
  EXPECT_FALSE(std::filesystem::exists(scan));
  expectOneLineError(run({"simulate-scan", ball, "-o", scan, "--from", "up"}), {"--from", "up"});
}

} // namespace
} // namespace patina::test
#endif
