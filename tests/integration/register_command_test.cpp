// Registers a scan's path to its mesh, by the command.
#include <cmath>

#include <gtest/gtest.h>

#include "core/csv.h"
#include "core/file.h"
#include "integration/program.h"

namespace patina::test {
namespace {

class RegisteredScans : public testing::Test {
 protected:
  // Returns the filtered path of a simulated scan of a model.
  void scan(const std::string& model, const std::string& from, const std::string& seconds = "20",
            const std::string& seed = "5") {
    mesh = folder / (model + ".ply");
    scanned = folder / "scan";
    path = folder / "path.csv";
    out = folder / "registered.csv";
    ASSERT_EQ(run({"model", model, "-o", mesh}).exit, 0);
    ASSERT_EQ(run({"simulate-scan", mesh, "-o", scanned, "--seed", seed, "--from", from,
                   "--seconds", seconds})
                  .exit,
              0);
    ASSERT_EQ(run({"filter", scanned, "-o", path}).exit, 0);
  }

  ScratchFolder folder;
  std::string mesh, scanned, path, out;
};

TEST_F(RegisteredScans, FindTheirPoseWithoutAFirstGuess) {
  scan("dinosaur", "+x");
  const Json report = runJson({"register", mesh, path, "-o", out, "--compliance", "3.333e-4",
                               "--truth", scanned + "/truth.json"});
  EXPECT_TRUE(report.at("converged").asBool());
  EXPECT_GT(report.at("starts").asInteger(), 1);
  EXPECT_LT(report.at("error").asNumber(), 0.4e-3);
  EXPECT_LT(report.at("rms").asNumber(), 0.2e-3);
  EXPECT_TRUE(report.at("unobservable").asArray().empty());
  const CsvTable rows =
      readCsv(out, {"t [s]", "x [m]", "y [m]", "z [m]", "qx", "qy", "qz", "qw", "sigma [m]",
                    "force [N]", "face", "b0", "b1", "b2", "distance [m]"});
  ASSERT_EQ(static_cast<std::int64_t>(rows.rows.size()),
            report.at("samples").at("count").asInteger());
  for (const auto& row : rows.rows) {
    EXPECT_GE(row[10], 0);
    EXPECT_NEAR(row[11] + row[12] + row[13], 1, 1e-9);
    EXPECT_LT(std::abs(row[14]), 2e-3);
  }
}

TEST_F(RegisteredScans, GiveTheNextStroke) {
  scan("dinosaur", "+x", "4");
  const std::string stroke = folder / "next.csv";
  const Outcome outcome =
      run({"register", mesh, path, "-o", out, "--next-stroke", stroke, "--json"});
  EXPECT_LT(outcome.exit, 2) << outcome.err;
  const Json known = parseJson(outcome.out, "report").at("known");
  EXPECT_LT(known.at("pose_after").asNumber(), known.at("pose").asNumber());
  EXPECT_GT(readCsv(stroke, {"x [m]", "y [m]", "z [m]"}).rows.size(), 3U);
  expectOneLineError(run({"register", mesh, path, "-o", out, "--next-stroke", out}),
                     {"another output's file"});
}

// Each sample shows a little of a rotation, and all of them together only noise.
TEST_F(RegisteredScans, ReportUnobservableMotionsOnAPlate) {
  scan("plate", "+z", "8", "1");
  const Outcome outcome = run({"register", mesh, path, "-o", out, "--json"});
  const Json report = parseJson(outcome.out, "report");
  // A turned plate fits equally well: it is another pose, or the turn is free.
  const std::size_t free = report.at("unobservable").asArray().size();
  EXPECT_GE(free, 2U);
  EXPECT_EQ(outcome.exit, free == 3 ? 0 : 1);
  EXPECT_FALSE(report.at("unique").asBool());
  EXPECT_LT(report.at("deviation").at("shift").asNumber(), 1e-3);
}

// A distant sample would dominate the rotation of all the others.
TEST_F(RegisteredScans, LeaveOutASampleFartherThanTheMeshIsLong) {
  scan("dinosaur", "+x");
  const std::vector<std::string> words = {
      "register", mesh, path, "-o", out, "--truth", scanned + "/truth.json"};
  const Json report = runJson(words);
  std::string text = readFile(path);
  std::size_t row = 0;
  for (int line = 1; line < 50; ++line) row = text.find('\n', row) + 1;
  const std::size_t x = text.find(',', row) + 1;
  text.replace(x, text.find(',', x) - x, "10000");
  writeFileAtomically(path, text);
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_NE(outcome.err.find("path.csv: the sample at "), std::string::npos) << outcome.err;
  const Json again = runJson(words);
  EXPECT_EQ(again.at("samples").at("all").asInteger() + 1,
            report.at("samples").at("all").asInteger());
  EXPECT_NEAR(again.at("error").asNumber(), report.at("error").asNumber(), 0.02e-3);
  EXPECT_NEAR(again.at("deviation").at("shift").asNumber(),
              report.at("deviation").at("shift").asNumber(), 0.02e-3);
}

// Four seconds on a smooth back fit elsewhere as well, and the one fit is some millimetres off.
TEST_F(RegisteredScans, WarnOfAlternativePosesIfShort) {
  scan("dinosaur", "+z", "4", "2");
  const Outcome outcome = run({"register", mesh, path, "-o", out, "--json"});
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_NE(outcome.err.find("ambiguous"), std::string::npos) << outcome.err;
  const Json report = parseJson(outcome.out, "report");
  EXPECT_FALSE(report.at("unique").asBool());
  ASSERT_FALSE(report.at("rivals").asArray().empty());
  const Json& rival = report.at("rivals").asArray()[0];
  EXPECT_EQ(rival.at("mesh_from_scan").asArray().size(), 4U);
  EXPECT_GT(rival.at("away").asNumber(), 1e-3);
  // The search is skipped if only the first guess is requested.
  const Json alone =
      parseJson(run({"register", mesh, path, "-o", out, "--no-search", "--json"}).out, "report");
  EXPECT_EQ(alone.find("unique"), nullptr);
}

// A tip that is 4.7 mm off makes the path fit nowhere; with the corrected tip its pose is found and
// unique.
TEST_F(RegisteredScans, AreUniqueOnceAWrongTipIsCorrected) {
  scan("dinosaur", "+z", "20", "1");
  std::string rig = readFile(scanned + "/rig.json");
  const std::string tip = "\"tip\": [0.0, 0.0, -0.12]";
  ASSERT_NE(rig.find(tip), std::string::npos);
  rig.replace(rig.find(tip), tip.size(), "\"tip\": [0.004, 0.0025, -0.12]");
  writeFileAtomically(scanned + "/rig.json", rig);
  ASSERT_EQ(run({"filter", scanned, "-o", path}).exit, 0);
  const Json report =
      runJson({"register", mesh, path, "-o", out, "--refine", "--truth", scanned + "/truth.json"});
  EXPECT_TRUE(report.at("unique").asBool());
  EXPECT_TRUE(report.at("converged").asBool());
  EXPECT_LT(report.at("rms").asNumber(), 0.2e-3);
  EXPECT_LT(report.at("error").asNumber(), 2e-3);
}

// The body has the mesh's shape: the residuals are as small as the added roughness.
TEST_F(RegisteredScans, GiveHeightsOverTheirMesh) {
  scan("dinosaur", "-y");
  const std::string report = folder / "r.json", heights = folder / "heights.csv";
  ASSERT_EQ(
      run({"register", mesh, path, "-o", out, "--compliance", "3.333e-4", "--report", report}).exit,
      0);
  const Json found = runJson({"filter", scanned, "-o", path, "--heights", heights,
                              "--reference-mesh", mesh, "--registration", report});
  const Json& stiffness = found.at("stiffness");
  EXPECT_NEAR(stiffness.at("value").asNumber(), 3000, 3 * stiffness.at("deviation").asNumber());
  double squares = 0, count = 0, last = -1, stretch = -1;
  for (const auto& row :
       readCsv(heights, {"t [s]", "along [m]", "height [m]", "sigma [m]", "stretch"}).rows) {
    squares += row[2] * row[2];
    count += 1;
    if (row[4] == stretch) {
      EXPECT_GE(row[1], last);
    }
    last = row[1];
    stretch = row[4];
  }
  ASSERT_GT(count, 2000);
  EXPECT_LT(std::sqrt(squares / count), 0.3e-3) << "of a body of 100 mm";
  const std::string textured = folder / "textured.obj";
  EXPECT_EQ(run({"map-texture", mesh, out, "-o", textured, "--heights", heights}).exit, 0);
}

TEST_F(RegisteredScans, HaveOnePoseForSeveralFiles) {
  scan("dinosaur", "-y");
  const std::string again = folder / "again.csv";
  writeFileAtomically(again, readFile(path));
  const Json one = runJson({"register", mesh, path, "-o", out}),
             two = runJson({"register", mesh, path, "-o", out, "--with", again});
  EXPECT_EQ(two.at("samples").at("all").asInteger(), 2 * one.at("samples").at("all").asInteger());
  const auto matrix = [](const Json& report) { return report.at("mesh_from_scan").asArray(); };
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(matrix(one)[i].asArray()[3].asNumber(), matrix(two)[i].asArray()[3].asNumber(),
                0.5e-3);
  // Only the samples of the first one are written.
  EXPECT_LE(readCsv(out, {"t [s]", "x [m]"}).rows.size(),
            static_cast<std::size_t>(one.at("samples").at("all").asInteger()));
}

TEST_F(RegisteredScans, AreRefusedOverAMeshWithTheCause) {
  scan("sphere", "+z");
  const std::string heights = folder / "heights.csv", empty = folder.write("r.json", "{}");
  const auto filter = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"filter", scanned, "-o", path, "--heights", heights};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  expectOneLineError(filter({"--reference-mesh", mesh}), {"--reference-mesh", "--registration"});
  expectOneLineError(filter({"--reference-mesh", mesh, "--registration", empty}),
                     {"r.json", "mesh_from_scan"});
  expectOneLineError(filter({"--reference-mesh", folder / "none.ply", "--registration", empty}),
                     {"none.ply"});
  EXPECT_FALSE(std::filesystem::exists(heights));
  expectOneLineError(run({"register", mesh, path, "-o", out, "--with", mesh}), {"sphere.ply"});
}

// A09: a first guess by hand, as shift and turns, is the same as one by a matrix.
TEST_F(RegisteredScans, StartFromAFirstGuessByHand) {
  scan("dinosaur", "+x");
  const std::string pose =
      folder.write("pose.txt", "0 0 1 0.01\n1 0 0 -0.02\n0 1 0 0.4\n0 0 0 1\n");
  // The axes go y to z, z to x, x to y: a rotation about x by 90 degrees, then about the fixed z.
  const auto found = [&](const std::string& option, const std::string& value) {
    const Outcome outcome =
        run({"register", mesh, path, "-o", out, "--no-search", option, value, "--json"});
    return parseJson(outcome.out, "report").at("mesh_from_scan").dump();
  };
  EXPECT_EQ(found("--initial-values", "10mm,-20mm,0.4,90,0,90"), found("--initial", pose));
  expectOneLineError(run({"register", mesh, path, "-o", out, "--initial-values", "1,2,3"}),
                     {"--initial-values"});
  expectOneLineError(run({"register", mesh, path, "-o", out, "--initial-values", "0,0,0,0,0,0",
                          "--initial", pose}),
                     {"--initial"});
}

TEST_F(RegisteredScans, ReportFreeRotationsOnABall) {
  scan("sphere", "+z");
  const Json report = runJson({"register", mesh, path, "-o", out, "--compliance", "3.333e-4"});
  const auto& free = report.at("unobservable").asArray();
  ASSERT_EQ(free.size(), 3U);
  for (const Json& motion : free) EXPECT_EQ(motion.at("kind").asString(), "turn");
  EXPECT_FALSE(report.at("unique").asBool());
}

TEST_F(RegisteredScans, AreRefusedWithTheNameOfTheWrongFile) {
  scan("sphere", "+z");
  expectOneLineError(run({"register", mesh, folder / "none.csv", "-o", out}), {"none.csv"});
  expectOneLineError(run({"register", mesh, path}), {"-o", "missing"});
  expectOneLineError(run({"register", mesh, path, path, "-o", out}), {"too many"});
  expectOneLineError(run({"register", mesh, path, "-o", path}), {"path.csv"});
  expectOneLineError(run({"register", mesh, path, "-o", out, "--method", "magic"}), {"magic"});
  writeFileAtomically(folder / "truth.json", "{\"mesh_from_camera\": [[1, 0], [0, 1]]}\n");
  expectOneLineError(run({"register", mesh, path, "-o", out, "--truth", folder / "truth.json"}),
                     {"truth.json", "mesh_from_camera"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

// A path beside its rig.json has the radius of that probe's tip, as in `patina scan`.
TEST_F(RegisteredScans, TakeTheTipRadiusOfTheRigBesideThePath) {
  scan("sphere", "+z", "4");
  const std::string beside = scanned + "/path.csv", rig = scanned + "/rig.json";
  std::filesystem::copy_file(path, beside);
  ASSERT_LE(run({"register", mesh, beside, "-o", out, "--tip-radius", "0.4mm"}).exit, 1);
  const std::string by_option = readFile(out);
  ASSERT_LE(run({"register", mesh, beside, "-o", out}).exit, 1);
  EXPECT_NE(readFile(out), by_option) << "another radius is another place";
  writeFileAtomically(rig, parseJson(readFile(rig), rig).set("tip_radius", 0.4e-3).dump());
  ASSERT_LE(run({"register", mesh, beside, "-o", out}).exit, 1);
  EXPECT_EQ(readFile(out), by_option);
}

} // namespace
} // namespace patina::test
