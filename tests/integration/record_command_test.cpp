// Records frames and a probe into a scan folder that the next commands read.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "core/file.h"
#include "integration/program.h"

namespace patina::test {
namespace {

class RecordedScans : public testing::Test {
 protected:
  void SetUp() override {
    const std::string ball = folder / "ball.ply";
    ASSERT_EQ(run({"model", "sphere", "-o", ball}).exit, 0);
    scan = folder / "scan";
    made = folder / "made";
    source = "replay:" + scan;
  }
  void simulate(std::vector<std::string> more) const {
    more.insert(more.begin(), {"simulate-scan", folder / "ball.ply", "-o", scan});
    (void)runJson(more);
  }
  ScratchFolder folder;
  std::string scan, made, source;
};

TEST_F(RecordedScans, AreReadByTrackAndFilter) {
  simulate({"--seconds", "2", "--frames"});
  std::int64_t frames = 0;
  for (const auto& file : std::filesystem::directory_iterator(scan + "/frames"))
    frames += file.path().extension() == ".png";
  const Json report = runJson({"record", source, "--probe", source, "-o", made});
  EXPECT_EQ(report.at("frames").asInteger(), frames);
  EXPECT_GT(report.at("samples").asInteger(), 900);
  EXPECT_GT(report.at("frames_with_pose").asInteger() + report.at("skipped").asInteger(), 40);
  EXPECT_NEAR(report.at("seconds").asNumber(), static_cast<double>(frames) / 30, 1);
  // The first path uses the frames that were tracked live, the second all frames.
  const std::string path = folder / "path.csv";
  EXPECT_EQ(run({"filter", made, "-o", path}).exit, 0);
  const Json tracked = runJson({"track", made, "-o", made + "/poses.tum"});
  EXPECT_EQ(tracked.at("frames").asInteger(), report.at("frames").asInteger());
  EXPECT_GE(tracked.at("frames_with_pose").asInteger(), report.at("frames_with_pose").asInteger());
  EXPECT_EQ(run({"filter", made, "-o", path}).exit, 0);
}

TEST_F(RecordedScans, HoldFramesOnlyWithoutACameraFileAndAreTrackedAfterwards) {
  simulate({"--seconds", "1", "--frames"});
  const std::string camera = folder / "camera.yml", rig = folder / "rig.json";
  std::filesystem::rename(scan + "/camera.yml", camera);
  std::filesystem::rename(scan + "/rig.json", rig);
  const Outcome outcome = run({"record", source, "--probe", source, "-o", made, "--json"});
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("no camera.yml was given"), std::string::npos) << outcome.err;
  const Json report = parseJson(outcome.out, "report");
  const std::int64_t frames = report.at("frames").asInteger();
  EXPECT_GT(frames, 30);
  EXPECT_EQ(report.at("skipped").asInteger(), 0);
  EXPECT_FALSE(report.find("frames_with_pose"));
  EXPECT_FALSE(std::filesystem::exists(made + "/poses.tum"));
  const Json tracked =
      runJson({"track", made, "--camera", camera, "--rig", rig, "-o", made + "/poses.tum"});
  EXPECT_EQ(tracked.at("frames").asInteger(), frames);
  EXPECT_GT(tracked.at("frames_with_pose").asInteger(), 20);
}

TEST_F(RecordedScans, EndWithExit1AndAReportIfTheProbeSendsNothing) {
  simulate({"--seconds", "1", "--frames"});
  const Outcome outcome = run({"record", source, "--probe", "stream:/dev/null", "-o", made});
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_NE(outcome.err.find("the probe sent nothing"), std::string::npos) << outcome.err;
}

TEST_F(RecordedScans, EndNormallyWithCtrlCAndAfterTheirSeconds) {
  simulate({"--seconds", "2", "--frames"});
  Running record({"record", source, "--json", "-o", made}, programPath());
  for (int i = 0; i < 400 && !std::filesystem::exists(made + "/frames/000005.pgm"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  record.signal(SIGINT);
  const Outcome outcome = record.wait();
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const auto frames = parseJson(outcome.out, "report").at("frames").asInteger();
  EXPECT_GE(frames, 6);
  EXPECT_LT(frames, 60);
  std::filesystem::remove_all(made);
  const Json report = runJson({"record", source, "--seconds", "0.5", "-o", made});
  EXPECT_NEAR(report.at("seconds").asNumber(), 0.5, 0.3);
}

TEST_F(RecordedScans, RefuseUnreadableInputs) {
  simulate({"--seconds", "1", "--frames"});
  expectOneLineError(run({"record", "camera:97", "--camera", scan + "/camera.yml", "--rig",
                          scan + "/rig.json", "-o", made}),
                     {"camera:97", "/dev/video97"});
  expectOneLineError(run({"record", "camera:97", "-o", made}), {"camera:97", "/dev/video97"});
  expectOneLineError(run({"record", source, "-o", scan}), {"holds a scan already"});
  expectOneLineError(run({"record", source, "--probe", scan + "/probe.csv", "-o", made}),
                     {"share no clock"});
  expectOneLineError(run({"track", folder / "none.mp4", "-o", folder / "poses.tum"}),
                     {"none.mp4", "does not exist"});
  EXPECT_FALSE(std::filesystem::exists(made));
}

TEST_F(RecordedScans, HaveForcesOfKnownWeights) {
  simulate({"--seconds", "3"});
  const std::string rig = folder / "rig.json",
                    table = folder.write("weights.csv",
                                         "force [N],reading\n0,0.2\n1,0.7\n2,1.2\n3,9\n4,2.2\n");
  const Json report =
      runJson({"calibrate", table, "--force", "--rig", scan + "/rig.json", "-o", rig});
  EXPECT_EQ(report.at("rejected").asInteger(), 1);
  EXPECT_NEAR(report.at("parameters").at("force_gain").at("value").asNumber(), 2, 1e-9);
  const Json written = parseJson(readFile(rig), rig);
  EXPECT_NEAR(written.at("force_zero").asNumber(), 0.2, 1e-9);
  EXPECT_LT(written.at("force_gain_deviation").asNumber(), 1e-9);
  EXPECT_TRUE(written.find("accelerometers")); // its other values
  // The filter's forces follow.
  const std::string poses = scan + "/poses.tum", path = folder / "path.csv";
  const Json all = runJson(
      {"filter", poses, "--probe", scan + "/probe.csv", "--rig", rig, "--keep-air", "-o", path});
  EXPECT_GT(all.at("samples").asInteger(), 1000);
  const std::string bad = folder.write("bad.csv", "force [N],reading\n0,1\n1,2\n");
  expectOneLineError(run({"calibrate", bad, "--force", "-o", folder / "none.json"}),
                     {"bad.csv", "zero and gain"});
}

TEST_F(RecordedScans, NeedDifferentNamesForPathAndHeights) {
  simulate({"--seconds", "1"});
  std::filesystem::create_directory_symlink(folder.path(), folder / "link");
  expectOneLineError(
      run({"filter", scan, "-o", folder / "one.csv", "--heights", folder / "link/one.csv"}),
      {"is the path's file too"});
}

} // namespace
} // namespace patina::test
