// A scan folder becomes a textured mesh, also from the files of earlier steps.
#include "scan/run_scan.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "acquisition/registration_shapes.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json.h"
#include "geometry/io/mesh_io.h"
#include "scan/scan_files.h"
#include "scan/simulate_scan.h"
#include "support/fresh_folder.h"

namespace patina {
namespace {

class RunScan : public testing::Test {
 protected:
  RunScan() {
    SimulateScanOptions scan;
    scan.folder = folder_ / "scan";
    scan.mesh = test::lumpy(24);
    scan.unit = MeshUnit::m;
    scan.seconds = 12;
    simulateScan(scan, progress_);
    options_.folders = {scan.folder};
    options_.mesh = scan.folder / "mesh.obj";
    options_.unit = MeshUnit::m;
  }

  void setInJson(const char* file, const char* key, Json value) const {
    const std::filesystem::path path = folder_ / "scan" / file;
    writeFileAtomically(path, parseJson(readFile(path), file).set(key, std::move(value)).dump());
  }

  std::filesystem::path folder_ = test::freshFolder("run_scan");
  RunScanOptions options_;
  Progress progress_;
};

std::size_t linesWith(const RunScanReport& report, const std::string& words) {
  return static_cast<std::size_t>(
      std::count_if(report.warnings.begin(), report.warnings.end(),
                    [&](const std::string& line) { return line.find(words) != line.npos; }));
}

TEST_F(RunScan, WarnsIfATextureIsMappedAtAnUncertainPose) {
  options_.workspace = folder_ / "first";
  ASSERT_TRUE(runScan(options_, progress_).done);
  options_.from = ScanStep::texture;
  options_.workspace = folder_ / "again";
  EXPECT_EQ(linesWith(runScan(options_, progress_), "not certain"), 0U);
  setInJson("registration.json", "certain", false);
  options_.workspace = folder_ / "uncertain";
  const RunScanReport report = runScan(options_, progress_);
  EXPECT_TRUE(report.done);
  EXPECT_EQ(linesWith(report, "registration.json: its pose is uncertain"), 1U);
}

TEST_F(RunScan, KeepsACertainPoseFromAnUncertainOne) {
  options_.to = ScanStep::register_paths;
  ASSERT_TRUE(runScan(options_, progress_).done);
  const std::string before = readFile(folder_ / "scan" / "registered.csv");
  options_.unit = MeshUnit::cm; // a hundredth of its size
  const RunScanReport report = runScan(options_, progress_);
  EXPECT_FALSE(report.done);
  EXPECT_EQ(linesWith(report, "the certain pose of an earlier run is kept"), 1U);
  EXPECT_EQ(readFile(folder_ / "scan" / "registered.csv"), before);
}

// Gravity that points sideways contradicts the accelerometers.
TEST_F(RunScan, StopsAtWrongPathsInEachRun) {
  const std::filesystem::path other = folder_ / "other";
  setInJson("rig.json", "gravity", Json(Json::Array{9.80665, 0., 0.}));
  std::filesystem::copy(folder_ / "scan", other);
  options_.also = {other};
  options_.to = ScanStep::register_paths;
  for (int run = 0; run < 2; ++run) {
    const RunScanReport report = runScan(options_, progress_);
    EXPECT_FALSE(report.done);
    EXPECT_FALSE(report.registered) << "run " << run;
    EXPECT_EQ(linesWith(report, "contradict one another"), 2U) << "run " << run;
    EXPECT_EQ(linesWith(report, other.string() + ": accelerometers"), 1U) << "run " << run;
  }
}

TEST_F(RunScan, TakesTheTipRadiusFromTheRigUnlessGiven) {
  constexpr double kRadius = 0.4e-3; // [m]
  options_.to = ScanStep::register_paths;
  const auto placed = [&] { return readFile(folder_ / "scan" / "registered.csv"); };
  ASSERT_TRUE(runScan(options_, progress_).done);
  const std::string of_a_point = placed();
  options_.tip_radius = kRadius;
  ASSERT_TRUE(runScan(options_, progress_).done);
  const std::string of_the_option = placed();
  EXPECT_NE(of_the_option, of_a_point) << "another radius is another place";
  options_.tip_radius.reset();
  setInJson("rig.json", "tip_radius", kRadius);
  options_.from = ScanStep::register_paths;
  ASSERT_TRUE(runScan(options_, progress_).done);
  EXPECT_EQ(placed(), of_the_option);

  const std::filesystem::path other = folder_ / "other";
  std::filesystem::copy(folder_ / "scan", other);
  setInJson("rig.json", "tip_radius", 2 * kRadius);
  options_.also = {other};
  EXPECT_THROW(runScan(options_, progress_), FileError) << "two radii, and none is told";
  std::filesystem::remove(other / "rig.json");
  EXPECT_EQ(tipRadiusOf({folder_ / "scan", other}), 2 * kRadius)
      << "a folder without a rig has none";
}

} // namespace
} // namespace patina
