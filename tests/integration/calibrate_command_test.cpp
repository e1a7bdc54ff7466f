// `patina calibrate` reports a probe's tip, warns of doubtful values and refuses invalid ones.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <regex>

#include <Eigen/Geometry>

#include "acquisition/files/frame_files.h"
#include "core/file.h"
#include "integration/scans.h"
#include "support/printed_board.h"
#include "support/rendered_rig.h"

namespace patina::test {
namespace {

TEST_F(Scans, CalibrateFindsATipAndRefusesInsufficientPoses) {
  // A probe tilted to all sides about a tip 120 mm below its markers.
  std::string text;
  for (int i = 0; i < 40; ++i) {
    const double around = 0.8 * i, leaning = 0.1 + 0.015 * i;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(around, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(leaning, Eigen::Vector3d::UnitX()));
    const Eigen::Vector3d at =
        Eigen::Vector3d(0.1, 0, 0.5) - turn * Eigen::Vector3d(0, 0.01, -0.12);
    text += std::to_string(i);
    for (const double value : {at.x(), at.y(), at.z(), turn.x(), turn.y(), turn.z(), turn.w()})
      text += " " + std::to_string(value);
    text += "\n";
  }
  const std::string poses = folder / "turning.tum", rig = folder / "tip.json";
  writeFileAtomically(poses, text);
  const Json report = runJson({"calibrate", poses, "-o", rig});
  const Json& parameters = report.at("parameters");
  EXPECT_NEAR(parameters.at("y").at("value").asNumber(), 0.01, 1e-5);
  EXPECT_NEAR(parameters.at("z").at("value").asNumber(), -0.12, 1e-5);
  EXPECT_LT(parameters.at("z").at("deviation").asNumber(), 1e-4);
  EXPECT_NEAR(parseJson(readFile(rig), rig).at("tip").asArray()[2].asNumber(), -0.12, 1e-5);
  // A deviation has two digits, and its value as many decimals.
  const std::string shown = run({"calibrate", poses, "-o", rig}).out;
  std::smatch z;
  ASSERT_TRUE(std::regex_search(shown, z, std::regex(R"(z\s+-1\d\d\.(\d+) \+- 0\.(0*[1-9]\d) mm)")))
      << shown;
  EXPECT_EQ(z[1].length(), z[2].length()) << shown;
  std::filesystem::remove(rig);
  writeFileAtomically(poses, text.substr(0, text.find("\n5 ") + 1));
  expectOneLineError(run({"calibrate", poses, "-o", rig}), {"turning.tum", "tip"});
  EXPECT_FALSE(std::filesystem::exists(rig));
  const std::string camera = folder / "camera.yml";
  expectOneLineError(
      run({"calibrate", folder / "none", "--board", "chessboard:9x6:25mm", "-o", camera}),
      {"none"});
  expectOneLineError(run({"calibrate", folder / "none", "--board", "chess", "-o", camera}),
                     {"--board", "chessboard:COLUMNSxROWS"});
  (void)simulate({"--seconds", "3"}); // upright and moving
  expectOneLineError(run({"calibrate", scan, "--accelerometers", "-o", rig}), {"scan", "held still"});
  // The hand moves: whatever point fits best is no tip.
  expectOneLineError(run({"calibrate", scan + "/poses.tum", "-o", rig}), {"poses.tum", "tip"});
  EXPECT_FALSE(std::filesystem::exists(rig));
}

// A probe held in 12 attitudes of 0.8 s, its readings `unit` for a m/s^2.
void writeHeld(const std::filesystem::path& folder, double unit) {
  const Eigen::Vector3d down = 9.80665 * Eigen::Vector3d(0.1, 0.85, 0.5).normalized();
  const std::array<Eigen::Vector3d, 4> axes{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(),
                                            Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
  std::string poses, probe = "t [s],force [N],a1u [m/s^2],a1v [m/s^2],a2u [m/s^2],a2v [m/s^2]\n";
  for (int i = 0; i < 12; ++i) {
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(1.1 * std::sin(2.3 * i), Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(1.1 * std::cos(1.7 * i), Eigen::Vector3d::UnitY()));
    for (int k = 0; k < 24; ++k) {
      poses += std::to_string(0.8 * i + k / 30.) + " 0 0 0.5";
      for (const double value : {turn.x(), turn.y(), turn.z(), turn.w()})
        poses += " " + std::to_string(value);
      poses += "\n";
    }
    for (int k = 0; k < 400; ++k) {
      probe += std::to_string(0.8 * i + k / 500.) + ",0.03";
      for (const Eigen::Vector3d& axis : axes)
        probe += "," + std::to_string(-unit * axis.dot(turn.conjugate() * down));
      probe += "\n";
    }
  }
  std::filesystem::create_directories(folder);
  writeFileAtomically(folder / "poses.tum", poses);
  writeFileAtomically(folder / "probe.csv", probe);
}

TEST_F(Scans, CalibrateFindsGravityAndWarnsOfAnotherUnit) {
  const std::string held = folder / "held", rig = folder / "rig.json";
  writeHeld(held, 1);
  const Outcome told = run({"calibrate", held, "--accelerometers", "-o", rig});
  EXPECT_EQ(told.exit, 0) << told.err;
  EXPECT_NE(told.err.find("without --rig"), std::string::npos) << told.err;
  const Json gravity = parseJson(readFile(rig), rig).at("gravity");
  EXPECT_NEAR(gravity.asArray()[1].asNumber(), 9.80665 * 0.85 / std::sqrt(0.01 + 0.7225 + 0.25),
              0.02);
  const Outcome beside = run({"calibrate", held, "--accelerometers", "--rig", rig, "-o", rig});
  EXPECT_EQ(beside.exit, 0);
  EXPECT_EQ(beside.err.find("--rig"), std::string::npos) << beside.err;

  std::filesystem::remove(rig);
  writeHeld(held, 1 / 9.80665); // in g
  expectOneLineError(run({"calibrate", held, "--accelerometers", "-o", rig}),
                     {"probe.csv", "a1u", "gravity reads 1.0", "9.81", "m/s^2"});
  EXPECT_FALSE(std::filesystem::exists(rig));
}

TEST_F(Scans, CalibrateNamesTheRigOfItsTipWithForces) {
  const std::string table = folder.write("weights.csv", "force [N],reading\n0,1\n1,3\n2,5\n4,9\n"),
                    rig = folder / "rig.json";
  const Outcome told = run({"calibrate", table, "--force", "-o", rig});
  EXPECT_EQ(told.exit, 0) << told.err;
  EXPECT_NE(told.err.find("without --rig the tip is that of a common probe"), std::string::npos)
      << told.err;
}

// ChArUco boards of OpenCV before 4.6, in files named like a camera's.
class BoardPictures : public Scans {
 protected:
  void SetUp() override {
    const Board board = parseBoard(kBoard);
    const Camera camera = smallCamera();
    const FrameRenderer renderer(camera, printedBoard(board, true));
    std::mt19937 random(4);
    std::string list = "frame,t [s]\n";
    pictures = folder / "pictures";
    scan = folder / "scan";
    std::filesystem::create_directories(pictures);
    std::filesystem::create_directories(scan + "/frames");
    for (int i = 0; i < 6; ++i) {
      const GreyFrame view = renderer.render({boardPose(board, random, 0.35)}, boardLook(), 1);
      const std::string frame = scan + "/frames/" + frameStem(i) + ".png";
      writeGrey(frame, view);
      std::filesystem::copy_file(frame, pictures + "/IMG_" + std::to_string(7 + i) + ".JPG");
      list += std::to_string(i) + "," + std::to_string(0.05 * i) + "\n";
    }
    writeFileAtomically(pictures + "/Thumbs.db", "of a viewer");
    writeFileAtomically(scan + "/frames.csv", list);
  }

  static constexpr const char* kBoard = "charuco:6x8:25mm:18.75mm:4x4_50";
  std::string pictures;
};

TEST_F(BoardPictures, CalibrateACameraUnderAnyNameAndNameLeftOutFiles) {
  const std::string camera = folder / "camera.yml";
  const Outcome told = run({"calibrate", pictures, "--board", kBoard, "-o", camera});
  EXPECT_EQ(told.exit, 0) << told.err;
  EXPECT_NE(told.out.find("6 of 6 frames"), std::string::npos) << told.out;
  EXPECT_NE(told.err.find("pictures: 1 file is no picture and is left out: Thumbs.db"),
            std::string::npos)
      << told.err;
  const Json report = runJson({"calibrate", pictures, "--board", kBoard, "-o", camera});
  EXPECT_LT(report.at("rms_px").asNumber(), 0.35);
  const Json live = runJson({"calibrate", "replay:" + scan, "--board", kBoard, "-o", camera});
  EXPECT_EQ(live.at("views").asNumber(), 6);
  EXPECT_LT(live.at("rms_px").asNumber(), 0.35);
}

TEST_F(BoardPictures, CauseAWarningAndNoFileIfTheBoardDiffers) {
  const std::string camera = folder / "camera.yml";
  const Outcome told =
      run({"calibrate", pictures, "--board", "charuco:7x8:25mm:18.75mm:4x4_50", "-o", camera});
  EXPECT_EQ(told.exit, 1);
  EXPECT_NE(told.err.find("px, which is no calibration; is it charuco:7x8"), std::string::npos)
      << told.err;
  EXPECT_NE(told.err.find("the number of its squares"), std::string::npos) << told.err;
  EXPECT_FALSE(std::filesystem::exists(camera));
}

} // namespace
} // namespace patina::test
