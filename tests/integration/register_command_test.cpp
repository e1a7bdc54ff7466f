// A scan's path onto its mesh, by the command.
#ifdef PATINA_HAS_ACQUISITION
#include <gtest/gtest.h>

#include "core/csv.h"
#include "core/file.h"
#include "integration/program.h"

namespace patina::test {
namespace {

class RegisteredScans : public testing::Test {
 protected:
  // Filtered from a simulated scan of a model.
  void scan(const std::string& model, const std::string& from) {
    mesh = folder / (model + ".ply");
    scanned = folder / "scan";
    path = folder / "path.csv";
    out = folder / "registered.csv";
    ASSERT_EQ(run({"model", model, "-o", mesh}).exit, 0);
    ASSERT_EQ(run({"simulate-scan", mesh, "-o", scanned, "--seed", "5", "--from", from}).exit, 0);
    ASSERT_EQ(run({"filter", scanned, "-o", path}).exit, 0);
  }

  ScratchFolder folder;
  std::string mesh, scanned, path, out;
};

TEST_F(RegisteredScans, LandOnTheirMeshWithoutAGuess) {
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

TEST_F(RegisteredScans, OnABallAreFreeToTurn) {
  scan("sphere", "+z");
  const Json report = runJson({"register", mesh, path, "-o", out, "--compliance", "3.333e-4"});
  const auto& free = report.at("unobservable").asArray();
  ASSERT_EQ(free.size(), 3U);
  for (const Json& motion : free) EXPECT_EQ(motion.at("kind").asString(), "turn");
}

TEST_F(RegisteredScans, AreRefusedWithTheFileThatIsWrong) {
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

} // namespace
} // namespace patina::test
#endif
