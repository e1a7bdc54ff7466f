#include "acquisition/files/frame_files.h"
#include "acquisition/files/scan_tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/error.h"
#include "core/file.h"
#include "support/fresh_folder.h"

namespace patina {
namespace {

class ScanFiles : public testing::Test {
 protected:
  ScanFiles() : folder(test::freshFolder("scan_files")) {}
  ~ScanFiles() override { std::filesystem::remove_all(folder); }

  std::filesystem::path written(const std::string& text) const {
    std::ofstream(folder / "file") << text;
    return folder / "file";
  }
  // Returns the reader's message on a text: "file:LINE: cause" without the folder.
  template <class Read> std::string refusal(const Read& read, const std::string& text) const {
    try {
      (void)read(written(text));
    } catch (const FileError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos);
      return what.substr(folder.string().size() + 1);
    }
    return "taken";
  }

  std::filesystem::path folder;
};

TEST_F(ScanFiles, PosesReadBackBitForBit) {
  std::vector<CameraPose> poses(3);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].t = 1e9 + 0.1 * static_cast<double>(i);
    poses[i].position = Vec3(0.1, -1. / 3, 1e-9);
    poses[i].orientation = Eigen::AngleAxisd(0.3 * static_cast<double>(i), Vec3::UnitX());
  }
  writePoses(folder / "poses.tum", poses);
  const OnFile<CameraPose> back = readPoses(folder / "poses.tum");
  ASSERT_EQ(back.values.size(), 3u);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(back.values[i].t, poses[i].t);
    EXPECT_EQ(back.values[i].position, poses[i].position);
    EXPECT_TRUE(back.values[i].orientation.isApprox(poses[i].orientation, 1e-15));
    EXPECT_EQ(back.lines[i], i + 2) << "after the comment";
  }
}

TEST_F(ScanFiles, PosesMayHaveDeviations) {
  const auto file = readPoses(written("\xEF\xBB\xBF"
                                      "0 1 2 3 0 0 0 1 # one\n\n0.1 1 2 3 0 0 0 -1 1e-4 0.002\n"),
                              {0.5e-3, 0.01});
  ASSERT_EQ(file.values.size(), 2u);
  EXPECT_EQ(file.values[0].sigma_position, 0.5e-3);
  EXPECT_EQ(file.values[0].sigma_angle, 0.01);
  EXPECT_EQ(file.values[1].sigma_position, 1e-4);
  EXPECT_EQ(file.values[1].sigma_angle, 0.002);
  EXPECT_EQ(file.lines[1], 3u);
}

TEST_F(ScanFiles, PosesTellADoubtOfTheirRig) {
  const std::string doubt = "marker 3 lies 0.4 mm off";
  std::vector<std::string> warnings;
  const auto doubted = parsePoses(posesText({CameraPose()}, {}, doubt), "p.tum", {}, &warnings);
  EXPECT_TRUE(doubted.values[0].rig_doubted);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "p.tum: of the rig's markers: " + doubt);
  EXPECT_FALSE(parsePoses(posesText({CameraPose()}, {}), "p.tum").values[0].rig_doubted);
}

TEST_F(ScanFiles, InvalidPosesAreRejectedWithTheirLine) {
  const auto read = [](const std::filesystem::path& path) { return readPoses(path); };
  const std::string good = "0 1 2 3 0 0 0 1\n";
  EXPECT_EQ(refusal(read, ""), "file: there is no pose in it");
  EXPECT_EQ(refusal(read, "# t x y z\n"), "file: there is no pose in it");
  EXPECT_TRUE(refusal(read, good + "0,1 1 2 3 0 0 0 1\n").starts_with("file:2: decimal commas"));
  EXPECT_EQ(refusal(read, good + "1 1 nan 3 0 0 0 1\n"), "file:2: ty [m] is not a finite number");
  EXPECT_EQ(refusal(read, good + "1 1 2 1e30 0 0 0 1\n"), "file:2: tz [m] is 1e+30, out of range");
  EXPECT_TRUE(refusal(read, good + "1 1 x 3 0 0 0 1\n").starts_with("file:2: 'x' is not"));
  EXPECT_TRUE(refusal(read, good + "1 1 2 3 0 0 1\n").starts_with("file:2: 7 numbers where"));
  EXPECT_TRUE(refusal(read, good + "1 1 2 3 0 0 0 1 1\n").starts_with("file:2: 9 numbers where"));
  EXPECT_EQ(refusal(read, good + "-1 1 2 3 0 0 0 1\n"), "file:2: time runs backwards");
  EXPECT_EQ(refusal(read, good + "\n" + good), "file:3: time repeats");
  EXPECT_TRUE(refusal(read, good + "1 1 2 3 0 0 0 0\n").starts_with("file:2: the quaternion's"));
  EXPECT_EQ(refusal(read, "0 1 2 3 0 0 0 1 0 0.1\n"), "file:1: deviations must be above 0");
}

TEST_F(ScanFiles, PosesMayBeATable) {
  std::vector<std::string> warnings;
  const auto file =
      readPoses(written("t [ms];tz [mm];tx [mm];ty [mm];qw;qx;qy;qz;frame\r0;3;1;2;1;0;0;0;7\r"
                        "100,5;3;1;2;-1;0;0;0;8\r"),
                {0.5e-3, 0.01}, &warnings);
  ASSERT_EQ(file.values.size(), 2u);
  EXPECT_EQ(file.values[1].t, 0.1005);
  EXPECT_EQ(file.values[0].position, Vec3(0.001, 0.002, 0.003));
  EXPECT_EQ(file.values[1].orientation.w(), -1);
  EXPECT_EQ(file.values[1].sigma_angle, 0.01);
  EXPECT_EQ(file.lines[1], 3u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].ends_with("file: column left out: frame")) << warnings[0];
  const std::string head = "t [s],tx [m],ty [m],tz [m],qx,qy,qz,qw,sigma [m],sigma_angle [deg]\n";
  EXPECT_EQ(readPoses(written(head + "0,1,2,3,0,0,0,1,1e-4,180\n")).values[0].sigma_angle, M_PI);
  const auto read = [](const std::filesystem::path& path) { return readPoses(path); };
  EXPECT_EQ(refusal(read, head + "0,1,1.#IND,3,0,0,0,1,1e-4,180\n"),
            "file:2: ty [m] is not a finite number");
  EXPECT_EQ(refusal(read, head), "file: there is no pose in it");
  EXPECT_NE(refusal(read, "t tx ty tz qx qy qz qw\n0 1 2 3 0 0 0 1\n").find("it lacks 't [s]'"),
            std::string::npos);
}

TEST_F(ScanFiles, PosesMayHaveTheLineEndsOfOldMacs) {
  const auto file = readPoses(written("# t x\r0 1 2 3 0 0 0 1\r\r0.1 1 2 3 0 0 0 -1\r"));
  ASSERT_EQ(file.values.size(), 2u);
  EXPECT_EQ(file.lines[1], 4u);
}

TEST_F(ScanFiles, ProbeStreamsOfOtherProgramsAreRead) {
  const std::string text = "battery [V];t [ms];force [mN];a1u [g];a1v [g];a2u [mg];a2v [m/s^2]\r\n"
                           "3,7;0;1500;0;1;1000;2,5\r\n3,7;2,5;1500;0;1;1000;2,5\r\n";
  std::vector<std::string> warnings;
  const auto samples = parseProbeStream(text, "probe.csv", &warnings).values;
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[1].t, 0.0025);
  EXPECT_EQ(samples[0].force, 1.5);
  EXPECT_EQ(samples[0].acceleration[1], 9.80665);
  EXPECT_EQ(samples[0].acceleration[2], 9.80665);
  EXPECT_EQ(samples[0].acceleration[3], 2.5);
  EXPECT_EQ(warnings, std::vector<std::string>{"probe.csv: column left out: battery [V]"});
  ProbeLines lines("pipe");
  std::vector<ProbeSample> live;
  std::vector<RateSample> rates;
  for (const char c : text) lines.take({&c, 1}, live, &rates);
  lines.end();
  EXPECT_TRUE(rates.empty());
  ASSERT_EQ(live.size(), 2u);
  EXPECT_EQ(live[1].t, 0.0025);
}

TEST_F(ScanFiles, LinesOfAGyroscopeReadBackBitForBit) {
  const std::vector<ProbeSample> samples = {{0, 0.1, {1, 2, 3, 4}}, {0.002, 1, {5, 6, 7, 8}}};
  const std::vector<RateSample> rates = {{0, {0.1, 0.2, 1. / 3}}, {0.002, {-1, 2, 3}}};
  writeProbeStream(folder / "probe.csv", samples, rates);
  const std::string text = readFile(folder / "probe.csv");
  EXPECT_EQ(probeHeader(true) + probeRow(samples[0], &rates[0]) + probeRow(samples[1], &rates[1]),
            text);
  std::vector<RateSample> back;
  EXPECT_EQ(readProbeStream(folder / "probe.csv", nullptr, &back).values.size(), 2u);
  ProbeLines lines("pipe");
  std::vector<ProbeSample> live;
  std::vector<RateSample> live_rates;
  for (const char c : text) lines.take({&c, 1}, live, &live_rates);
  for (const auto& read : {back, live_rates}) {
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].rate, rates[0].rate);
    EXPECT_EQ(read[1].t, 0.002);
  }
  ProbeLines half("pipe");
  EXPECT_THROW(half.take("t [s],force [N],a1u [m/s^2],a1v [m/s^2],a2u [m/s^2],a2v [m/s^2],"
                         "wx [rad/s]\n0,0,0,0,0,0,0\n",
                         live, &live_rates),
               FileError);
}

TEST_F(ScanFiles, TablesReadBackBitForBit) {
  const std::vector<ProbeSample> samples = {{0, 0.1, {1, 2, 3, 4}}, {0.002, -1. / 3, {5, 6, 7, 8}}};
  writeProbeStream(folder / "probe.csv", samples);
  const OnFile<ProbeSample> back = readProbeStream(folder / "probe.csv");
  ASSERT_EQ(back.values.size(), 2u);
  EXPECT_EQ(back.values[1].t, 0.002);
  EXPECT_EQ(back.values[1].force, -1. / 3);
  EXPECT_EQ(back.values[1].acceleration, samples[1].acceleration);
  EXPECT_EQ(back.lines[1], 3u);

  PathSample sample;
  sample.position = Vec3(1. / 3, 2, 3);
  sample.orientation = Eigen::AngleAxisd(1, Vec3::UnitZ());
  sample.sigma = 1e-4;
  sample.force = 0.7;
  writePath(folder / "path.csv", {sample});
  EXPECT_TRUE(
      readFile(folder / "path.csv")
          .starts_with("t [s],x [m],y [m],z [m],qx,qy,qz,qw,sigma [m],force [N]\n0,0.33333"));
  const PathSample same = readPath(folder / "path.csv").at(0);
  EXPECT_EQ(same.position, sample.position);
  EXPECT_EQ(same.sigma, 1e-4);
  EXPECT_EQ(same.force, 0.7);
  EXPECT_TRUE(same.orientation.isApprox(sample.orientation, 1e-15));
}

TEST_F(ScanFiles, InvalidTablesAreRejectedWithTheirLine) {
  const auto read = [](const std::filesystem::path& path) { return readProbeStream(path); };
  const std::string head = "t [s],force [N],a1u [m/s^2],a1v [m/s^2],a2u [m/s^2],a2v [m/s^2]\n";
  EXPECT_TRUE(refusal(read, "").starts_with("file: is empty"));
  EXPECT_EQ(refusal(read, head), "file: there is no sample in it");
  EXPECT_TRUE(refusal(read, head + "0,0,0,1,0,2,0,3,0,4,0,5\n").starts_with("file:2: decimal"));
  EXPECT_EQ(refusal(read, head + "0,nan,1,2,3,4\n"), "file:2: force [N] is not a finite number");
  EXPECT_EQ(refusal(read, head + "0,-1e300,1,2,3,4\n"),
            "file:2: force [N] is -1e+300, out of range");
  EXPECT_EQ(refusal(read, head + "1e12,0,1,2,3,4\n"), "file:2: t [s] is 1e+12, out of range");
  EXPECT_EQ(refusal(read, head + "1.8e9,0,1,2,3,4\n"), "taken");
  EXPECT_EQ(refusal(read, head + "1,0,1,2,3,4\n0.5,0,1,2,3,4\n"), "file:3: time runs backwards");
  EXPECT_EQ(refusal(read, head + "1,0,1,2,3,4\n1,0,1,2,3,4\n"), "file:3: time repeats");
}

TEST_F(ScanFiles, RigReadsBackAndNeedsNoAccelerometers) {
  Rig rig;
  rig.accelerometers = true;
  rig.probe.tip = Vec3(0.001, 0.002, -0.1);
  rig.probe.axes[2].direction = Vec3(0.6, 0.8, 0);
  rig.gravity = Vec3(1, 9, 2);
  rig.probe.force_noise = 0.5;
  rig.force_zero = -0.25;
  rig.tip_radius = 0.5e-3;
  const Rig back = readRig(written(rigText(rig)));
  EXPECT_TRUE(back.accelerometers);
  EXPECT_EQ(back.probe.tip, rig.probe.tip);
  EXPECT_TRUE(back.probe.axes[2].direction.isApprox(rig.probe.axes[2].direction, 1e-15));
  EXPECT_EQ(back.gravity, rig.gravity);
  EXPECT_EQ(back.probe.force_noise, 0.5);
  EXPECT_EQ(back.force_zero, -0.25);
  EXPECT_EQ(back.tip_radius, 0.5e-3);

  const Rig bare = readRig(written("{\"tip\": [0, 0, -0.1], \"markers\": [{\"id\": 3}]}"));
  EXPECT_FALSE(bare.accelerometers);
  EXPECT_EQ(bare.probe.tip, Vec3(0, 0, -0.1));

  const auto read = [](const std::filesystem::path& path) { return readRig(path); };
  EXPECT_NE(refusal(read, "{}").find("tip"), std::string::npos);
  EXPECT_NE(refusal(read, "{\"tip\": [0, 1]}").find("three numbers"), std::string::npos);
  EXPECT_TRUE(refusal(read, "{\n\"tip\": oops}").starts_with("file:2:"));
  EXPECT_NE(refusal(read, "{\"tip\": [0, 1, 2], \"accelerometers\": {}}").find("a1u"),
            std::string::npos);
  EXPECT_NE(refusal(read, "{\"tip\": [0, 1, 2], \"force_noise\": -1}").find("force_noise"),
            std::string::npos);
}

TEST_F(ScanFiles, MarkersReadBack) {
  RigMarker marker{"4x4_50", 3, 0.024, Pose::Identity()};
  marker.probe_from_marker.linear() =
      Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  marker.probe_from_marker.translation() = Vec3(0.01, -0.02, 0.03);
  const auto back = readMarkers(written(rigText({}, {marker})));
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].family, marker.family);
  EXPECT_EQ(back[0].id, marker.id);
  EXPECT_EQ(back[0].size, marker.size);
  EXPECT_TRUE(back[0].probe_from_marker.isApprox(marker.probe_from_marker, 1e-12));
}

TEST_F(ScanFiles, ImpossibleMarkersAreRejected) {
  const auto read = [](const std::filesystem::path& path) { return readMarkers(path); };
  const std::string good = rigText({}, {{"4x4_50", 3, 0.024, Pose::Identity()}});
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(refusal(read, good), "taken");
  EXPECT_EQ(readMarkers(written(with("4x4_50", "DICT_4X4_50")))[0].family, "4x4_50");
  EXPECT_NE(refusal(read, "{\"markers\": []}"), "taken");
  EXPECT_NE(refusal(read, "{\"tip\": [0, 0, 0]}"), "taken");
  EXPECT_NE(refusal(read, with("0.024", "-0.024")), "taken");
  EXPECT_NE(
      refusal(read, rigText({}, {{"a", 3, 1, Pose::Identity()}, {"a", 3, 1, Pose::Identity()}})),
      "taken");
  RigMarker bent{"4x4_50", 3, 0.024, Pose::Identity()};
  bent.probe_from_marker.linear()(0, 0) = 2;
  EXPECT_NE(refusal(read, rigText({}, {bent})), "taken");
}

} // namespace
} // namespace patina
