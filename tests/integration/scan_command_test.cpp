// A scan from its simulation to the path: the folder's files, the report, refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "core/csv.h"
#include "core/file.h"
#include "core/numbers.h"
#include "integration/scans.h"

namespace patina::test {
namespace {

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
    EXPECT_GT(row[9], 0) << "only samples in contact form the path";
  }
}

TEST_F(Scans, ReportThePoseOfTheMesh) {
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
      ASSERT_NEAR(std::sqrt(square), 0.05, 0.6e-3) << from; // radius; it is compliant
      touching += 1;
    }
    EXPECT_GT(touching, 1000);
  }
}

TEST_F(Scans, LeaveNoPathOfAnotherScanBesideThem) {
  simulate({"--seconds", "2"});
  const std::string left = scan + "/path.csv", poses = readFile(scan + "/poses.tum");
  ASSERT_EQ(run({"filter", scan, "-o", left}).exit, 0);
  expectOneLineError(run({"simulate-scan", ball, "-o", scan, "--seconds", "3"}), {"path.csv"});
  EXPECT_EQ(readFile(scan + "/poses.tum"), poses);
}

TEST_F(Scans, RefuseAFileOfImpossiblePoses) {
  simulate({"--seconds", "2"});
  std::filesystem::resize_file(scan + "/poses.tum", 4'000'000'000); // sparse
  expectOneLineError(run({"filter", scan, "-o", path}), {"poses.tum", "larger than"});
  std::filesystem::resize_file(scan + "/poses.tum", 0);
}

TEST_F(Scans, AreRefusedIfThePosesAreInMillimetres) {
  simulate({"--seconds", "2"});
  std::istringstream lines(readFile(scan + "/poses.tum"));
  std::string text;
  for (std::string line; std::getline(lines, line); text += line + "\n") {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream values(line);
    line.clear();
    int column = 0;
    for (double value = 0; values >> value; ++column)
      line += formatNumber(column >= 1 && column <= 3 ? 1e3 * value : value) + " ";
  }
  refused("poses.tum", text, {"poses.tum", "m away from the camera", "not mm"});
}

TEST_F(Scans, AreTheSameForTheSameOptions) {
  simulate();
  const std::string first = readFile(scan + "/probe.csv") + readFile(scan + "/poses.tum");
  simulate();
  EXPECT_TRUE(first == readFile(scan + "/probe.csv") + readFile(scan + "/poses.tum"));
  simulate({"--seed", "2"});
  EXPECT_FALSE(first == readFile(scan + "/probe.csv") + readFile(scan + "/poses.tum"));
}

TEST_F(Scans, GiveHeightsOnRequest) {
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
  const std::string link = folder / "link.csv";
  std::filesystem::create_symlink("path.csv", link); // its target does not exist yet
  refused({"--heights", link}, "is the path's file too");
}

// Each input is well formed, but they contradict one another: the command reports it.
TEST_F(Scans, ReportContradictions) {
  simulate({"--seconds", "8"});
  const std::string contradict = "contradict one another";
  const auto says = [&](const std::string& words) {
    const Outcome outcome = run({"filter", scan, "-o", path});
    EXPECT_EQ(outcome.exit, outcome.err.find(contradict) != std::string::npos ? 1 : 0);
    return outcome.err.find(words) != std::string::npos;
  };
  EXPECT_FALSE(says(contradict) || says("clock was not found") || says("rejected"));
  const std::string probe = readFile(scan + "/probe.csv"), rig = readFile(scan + "/rig.json"),
                    poses = readFile(scan + "/poses.tum");
  CsvTable rows = readCsv(scan + "/probe.csv", {"t [s]", "force [N]"});
  const auto write = [&](const auto& change) {
    std::string text = probe.substr(0, probe.find('\n') + 1);
    for (std::vector<double> row : rows.rows) {
      change(row);
      for (std::size_t i = 0; i < row.size(); ++i)
        text += (i > 0 ? "," : "") + formatNumber(row[i]);
      text += "\n";
    }
    writeFileAtomically(scan + "/probe.csv", text);
  };
  write([](std::vector<double>& row) {
    for (std::size_t i = 2; i < 6; ++i) row[i] /= 9.80665;
  });
  EXPECT_TRUE(says(contradict)) << "in g";
  write([](std::vector<double>& row) { std::swap(row[2], row[3]); });
  EXPECT_TRUE(says(contradict)) << "axes swapped";
  write([](std::vector<double>& row) { row[0] += 0.8; });
  EXPECT_TRUE(says(contradict) || says("clock was not found")) << "another clock";
  writeFileAtomically(scan + "/probe.csv", probe);
  std::string turned = rig;
  const std::size_t at = turned.find("\"gravity\"");
  turned.replace(at, turned.find(']', at) - at, "\"gravity\": [0, 9.80665, 0");
  writeFileAtomically(scan + "/rig.json", turned);
  EXPECT_TRUE(says(contradict)) << "gravity";
  writeFileAtomically(scan + "/rig.json", rig);
  std::istringstream lines(poses);
  std::string far; // every second pose half a metre on
  bool other = false;
  for (std::string line; std::getline(lines, line); far += line + "\n") {
    if (line.empty() || line[0] == '#' || !(other = !other)) continue;
    const std::size_t from = line.find(' ') + 1, to = line.find(' ', from);
    const double x = *parseNumber(line.substr(from, to - from));
    line.replace(from, to - from, formatNumber(x + 0.5));
  }
  writeFileAtomically(scan + "/poses.tum", far);
  // Neither half is believed; where some poses are used, the others are counted.
  const Outcome halves = run({"filter", scan, "-o", path});
  EXPECT_NE(halves.exit, 0);
  if (halves.exit == 2) expectOneLineError(halves, {"poses.tum", "poses were rejected"});
  EXPECT_NE(halves.err.find("poses were rejected"), std::string::npos) << halves.err;
}

TEST_F(Scans, ReportTheirFaults) {
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

TEST_F(Scans, MayBePosesAlone) {
  simulate();
  const std::string poses = scan + "/poses.tum";
  const Json alone = runJson({"filter", poses, "-o", path, "--truth", scan + "/truth.csv"});
  EXPECT_EQ(alone.at("model").asString(), "acceleration");
  const Json with = runJson({"filter", poses, "--probe", scan + "/probe.csv", "-o", path, "--truth",
                             scan + "/truth.csv", "--smooth"});
  EXPECT_EQ(with.at("model").asString(), "fused");
  EXPECT_LT(with.at("error").at("rms").asNumber(), alone.at("error").at("rms").asNumber());
  const Json forward =
      runJson({"filter", scan, "-o", path, "--no-smoother", "--model", "velocity", "--keep-air"});
  EXPECT_GT(forward.at("error").at("rms").asNumber(), alone.at("error").at("rms").asNumber());
  expectOneLineError(run({"filter", scan, "-o", path, "--no-smoother", "--model", "fused"}),
                     {"--no-smoother"});
  expectOneLineError(run({"filter", poses, "-o", path, "--model", "fused"}), {"--probe"});
}

TEST_F(Scans, NameTheLineOfAProbeGapIfItsClockIsBehind) {
  simulate({"--clock-offset", "-0.3"});
  const std::string whole = readFile(scan + "/probe.csv");
  std::string holed;
  std::size_t at = 0;
  for (int line = 1; at < whole.size(); ++line) {
    const std::size_t end = whole.find('\n', at) + 1;
    if (line < 1000 || line >= 1250) holed += whole.substr(at, end - at);
    at = end;
  }
  writeFileAtomically(scan + "/probe.csv", holed);
  const Outcome outcome = run({"filter", scan, "-o", path});
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_NE(outcome.err.find("probe.csv:1000: before this line 0.502"), std::string::npos)
      << outcome.err;
}

// The whole chain uses only its files.
TEST_F(Scans, RunFromFramesToPath) {
  const Json made = simulate({"--frames", "--seconds", "4", "--dropouts", "1"});
  EXPECT_EQ(made.find("poses"), nullptr);
  const std::int64_t frames = made.at("frames").asInteger();
  EXPECT_GT(frames, 100);
  const std::string poses = scan + "/poses.tum";
  const Json tracked = runJson({"track", scan, "-o", poses});
  EXPECT_EQ(tracked.at("frames").asInteger(), frames);
  // An object hides the markers in the dropout of 0.3 s.
  EXPECT_NEAR(tracked.at("frames_with_pose").asNumber(), static_cast<double>(frames) - 9, 3);
  EXPECT_EQ(tracked.at("without_pose").asArray().size(),
            static_cast<std::size_t>(frames - tracked.at("frames_with_pose").asInteger()));
  EXPECT_EQ(tracked.at("unreadable").asInteger(), 0);
  EXPECT_LT(tracked.at("reprojection_rms_px").asNumber(), 0.15);
  EXPECT_NE(readFile(poses).find(" no pose: no marker of the rig"), std::string::npos);
  const Json report = runJson({"filter", scan, "-o", path});
  EXPECT_EQ(report.at("model").asString(), "fused");
  EXPECT_EQ(report.at("gaps").asArray().size(), 1u);
  EXPECT_LT(report.at("error").at("rms").asNumber(), 0.3e-3);
  const double nees = report.at("error").at("nees").asNumber();
  std::printf("from frames to the path: NEES %.2f\n", nees);
  EXPECT_GT(nees, 0.4);
  EXPECT_LT(nees, 2.5);
  for (const auto& nis : report.at("nis_probe").asArray()) EXPECT_LT(nis.asNumber(), 1.5);

  // Bad input: one line, nothing written.
  const std::string other = folder / "other.tum";
  const auto trackRefused = [&](const std::vector<std::string>& parts) {
    expectOneLineError(run({"track", scan, "-o", other}), parts);
    EXPECT_FALSE(std::filesystem::exists(other));
  };
  const std::string camera = readFile(scan + "/camera.yml"), rig = readFile(scan + "/rig.json");
  writeFileAtomically(scan + "/camera.yml",
                      std::string(camera).replace(camera.find("640"), 3, "320"));
  trackRefused({"000000.png", "640 x 480", "320 x 480"});
  writeFileAtomically(scan + "/camera.yml", "%YAML:1.0\n");
  trackRefused({"camera.yml", "image_width"});
  writeFileAtomically(scan + "/camera.yml", camera);
  writeFileAtomically(scan + "/rig.json", "{\"markers\": []}");
  trackRefused({"rig.json", "no marker"});
  std::string unknown = rig;
  while (unknown.find("4x4_50") != std::string::npos)
    unknown.replace(unknown.find("4x4_50"), 6, "4x4_51");
  writeFileAtomically(scan + "/rig.json", unknown);
  trackRefused({"rig.json", "4x4_51", "4x4_50"});
  std::filesystem::remove(scan + "/frames.csv");
  writeFileAtomically(scan + "/rig.json", rig);
  trackRefused({"frames.csv", "--rate"});
  // Another rig's markers give no pose. The words are correct, and nothing is written.
  std::string others = rig;
  for (std::size_t at = 0; (at = others.find("\"id\": ", at)) != std::string::npos; at += 6)
    others.insert(at + 6, "4");
  writeFileAtomically(scan + "/rig.json", others);
  EXPECT_EQ(run({"track", scan, "--rate", "30", "-o", other}).exit, 1);
  EXPECT_FALSE(std::filesystem::exists(other));
}

TEST_F(Scans, BelongToAWorkspaceStepByStep) {
  (void)simulate({"--frames", "--seconds", "1"});
  const std::string workspace = folder / "workspace", poses = scan + "/poses.tum";
  std::filesystem::remove(poses);
  ASSERT_EQ(
      run({"scene", "-o", workspace, "--add", ball, "--unit", "mm", "--scan", scan + "@rim"}).exit,
      0);
  EXPECT_FALSE(runJson({"info", workspace, "--no-field"}).at("scans").asArray().empty());
  ASSERT_EQ(run({"track", scan, "-o", poses}).exit, 0);
  const auto step = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"scene", "-o", workspace});
    return runJson(more);
  };
  step({"--scan", scan + "@rim"});
  const auto files = [](const Json& json) {
    std::string names;
    for (const Json& file : json.at("scans").asArray().at(0).at("files").asArray())
      names += file.asString() + " ";
    return names;
  };
  EXPECT_NE(files(step({})).find("poses.tum"), std::string::npos);
  const Outcome list = run({"undo", workspace, "--list"});
  EXPECT_NE(list.out.find("track scan rim"), std::string::npos) << list.out;
  EXPECT_EQ(runJson({"undo", workspace}).at("undone").asInteger(), 1);
  EXPECT_EQ(files(step({})).find("poses.tum"), std::string::npos);
  EXPECT_EQ(runJson({"redo", workspace}).at("redone").asInteger(), 1);
  step({"--remove-scan", "rim"});
  EXPECT_EQ(step({}).find("scans"), nullptr);
  EXPECT_EQ(runJson({"undo", workspace}).at("undone").asInteger(), 1);
  // One line is wrong, and nothing has happened.
  expectOneLineError(run({"scene", "-o", workspace, "--remove-scan", "cup"}), {"cup", "rim"});
  expectOneLineError(run({"scene", "-o", workspace, "--scan", folder / "none"}), {"none"});
  writeFileAtomically(scan + "/rig.json", "{}");
  expectOneLineError(run({"scene", "-o", workspace, "--scan", scan + "@rim"}), {"rig.json", "tip"});
  std::filesystem::remove(scan + "/frames/000003.png");
  const Outcome told = run({"info", workspace, "--no-field"});
  EXPECT_EQ(told.exit, 0);
  EXPECT_NE(told.err.find("other frames"), std::string::npos) << told.err;
}

TEST_F(Scans, DoNotMixTwoRecordingsUnderOneName) {
  const std::string workspace = folder / "workspace";
  (void)simulate({"--seconds", "2"});
  ASSERT_EQ(run({"filter", scan, "-o", scan + "/path.csv"}).exit, 0);
  const Outcome first =
      run({"scene", "-o", workspace, "--add", ball, "--unit", "mm", "--scan", scan});
  ASSERT_EQ(first.exit, 0) << first.err;
  const auto files = [&] {
    std::string names;
    const Json scene = runJson({"scene", "-o", workspace});
    for (const Json& file : scene.at("scans").asArray().at(0).at("files").asArray())
      names += file.asString() + " ";
    return names;
  };
  // The same recording without its path: the path stays, without a message.
  std::filesystem::remove(scan + "/path.csv");
  const Outcome same = run({"scene", "-o", workspace, "--scan", scan});
  EXPECT_EQ(same.exit, 0);
  EXPECT_EQ(same.err.find("path.csv"), std::string::npos) << same.err;
  EXPECT_NE(files().find("path.csv"), std::string::npos);
  (void)simulate({"--seconds", "2", "--seed", "2"});
  const Outcome other = run({"scene", "-o", workspace, "--scan", scan});
  EXPECT_EQ(other.exit, 0);
  EXPECT_NE(other.err.find("warning: scan scan: path.csv"), std::string::npos) << other.err;
  EXPECT_EQ(files().find("path.csv"), std::string::npos) << files();
  EXPECT_NE(files().find("poses.tum"), std::string::npos);
}

} // namespace
} // namespace patina::test
