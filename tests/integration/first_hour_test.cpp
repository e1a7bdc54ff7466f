// Four commands lead from nothing to a calibrated rig; a fifth shows how far the lab has come.
#include "core/file.h"
#include "integration/scans.h"
#include "support/first_hour.h"

namespace patina::test {
namespace {

TEST_F(Scans, FirstHourLeadsFromNothingToACalibratedRig) {
  const std::string rig = folder / "rig", board = folder / "board", wave = folder / "wave";
  const Camera camera = usualCamera();
  const Json printed = runJson({"rig", "print", "-o", rig});
  const Json none = runJson({"rig", "status", rig});
  EXPECT_TRUE(none.at("print").at("done").asBool());
  EXPECT_FALSE(none.at("photograph").at("done").asBool());
  const std::string text = printed.at("board").asString();
  EXPECT_NE(none.at("next").asString().find("calibrate camera:0 --board " + text),
            std::string::npos);

  writeBoardFrames(board, camera, parseBoard(text));
  const Json found =
      runJson({"calibrate", "replay:" + board, "--board", text, "-o", rig + "/camera.yml"});
  EXPECT_GE(found.at("views").asNumber(), 20);
  EXPECT_LT(found.at("rms_px").asNumber(), 0.2);
  EXPECT_NE(runJson({"rig", "status", rig}).at("next").asString().find("record camera:0"),
            std::string::npos);

  const GluedRig glued(rig + "/rig.json");
  glued.writeWave(wave, camera);
  (void)runJson({"record", wave, "--camera", rig + "/camera.yml", "--rig", rig + "/rig.json", "-o",
                 rig + "/wave"});
  EXPECT_NE(runJson({"rig", "status", rig}).at("next").asString().find("--length 0=SIZE"),
            std::string::npos);
  (void)runJson({"calibrate", rig + "/wave", "--length",
                 "0=" + std::to_string(glued.markers[0].size), "-o", rig + "/rig.json"});
  const double error = glued.tipError(rig + "/rig.json");
  std::printf("tip off by %.3f mm\n", 1e3 * error);
  EXPECT_LT(error, 0.15e-3);

  const Json done = runJson({"rig", "status", rig});
  EXPECT_TRUE(done.at("wave").at("done").asBool());
  EXPECT_EQ(done.at("wave").at("figure").asString().find("tip +- 0.0"), 0u)
      << done.at("wave").at("figure").asString();
  EXPECT_EQ(done.at("wave").at("remedy").asString(), "");
  EXPECT_FALSE(done.at("scan").at("done").asBool());
  EXPECT_NE(run({"rig", "status", rig}).out.find("px rms, 640 x 480"), std::string::npos);
  const std::string before = readFile(rig + "/rig.json");
  expectOneLineError(run({"rig", "print", "-o", rig}), {"rig.json", "is calibrated"});
  EXPECT_EQ(readFile(rig + "/rig.json"), before);
  (void)runJson({"record", wave, "--camera", rig + "/camera.yml", "--rig", rig + "/rig.json",
                 "--seconds", "0.5", "-o", rig + "/scan"});
  EXPECT_TRUE(runJson({"rig", "status", rig}).at("scan").at("done").asBool());
}

TEST_F(Scans, RigCommandsNameMissingFolders) {
  expectOneLineError(run({"rig", "status"}), {"rig status needs a FOLDER"});
  expectOneLineError(run({"rig", "print"}), {"rig print needs -o FOLDER"});
  expectOneLineError(run({"rig", "status", folder / "none"}), {"none", "is no folder"});
  expectOneLineError(run({"rig", "wave"}), {"wave", "print, status"});
}

} // namespace
} // namespace patina::test
