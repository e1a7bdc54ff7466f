// The stability map by the options of the commands.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "integration/program.h"

namespace patina::test {
namespace {

std::string text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream all;
  all << file.rdbuf();
  return all.str();
}

// A workspace of a sphere, R = 30 mm.
std::string sphereIn(const ScratchFolder& folder, const std::vector<std::string>& values) {
  const std::string mesh = folder / "ball.ply", scene = folder / "scene";
  EXPECT_EQ(run({"model", "sphere", "-o", mesh}).exit, 0);
  std::vector<std::string> words = {"scene", "-o", scene, "--add", mesh};
  for (const std::string& value : values) {
    words.push_back("--set");
    words.push_back(value);
  }
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  return scene;
}

TEST(StabilityCommands, InfoHasNoRatioWithoutADevice) {
  const ScratchFolder folder;
  const std::string scene = sphereIn(folder, {"stiffness=500", "resolution=60"});
  EXPECT_EQ(runJson({"info", scene}).find("stability"), nullptr);
  EXPECT_EQ(run({"info", scene}).out.find("K*/K"), std::string::npos);
}

TEST(StabilityCommands, InfoReportsTheSmallestRatioOfTheScenesDevice) {
  const ScratchFolder folder;
  const std::string scene =
      sphereIn(folder, {"stiffness=500", "resolution=60", "device.delay=2", "stabiliser=none"});
  const Json report = runJson({"info", scene});
  const Json& stability = report.at("stability");
  // 200.4 N/m with two samples of delay (MATH 2.1.3).
  EXPECT_NEAR(stability.at("ratio_min").asNumber(), 200.4 / 500, 0.01);
  EXPECT_NEAR(stability.at("limit").asNumber(), 200.4, 0.1);
  EXPECT_GT(stability.at("buzzing").asNumber(), 0.99);
  EXPECT_FALSE(stability.at("coupled").asBool());
  EXPECT_TRUE(stability.at("device_given").asBool());
  EXPECT_NE(run({"info", scene}).out.find("smallest K*/K 0.40"), std::string::npos);
}

TEST(StabilityCommands, MapIncludesTheCoupling) {
  const ScratchFolder folder;
  const std::string scene = sphereIn(
      folder, {"stiffness=5000", "resolution=60", "device.delay=2", "stabiliser=coupling"});
  const Json report = runJson({"info", scene});
  EXPECT_TRUE(report.at("stability").at("coupled").asBool());
  EXPECT_GT(report.at("stability").at("ratio_min").asNumber(), 1);
}

TEST(StabilityCommands, ExportWritesTheArraysOnlyIfAsked) {
  const ScratchFolder folder;
  const std::string scene = sphereIn(folder, {"stiffness=2000", "resolution=40"});
  ASSERT_EQ(run({"export", scene, "-o", folder / "plain"}).exit, 0);
  EXPECT_EQ(text(std::filesystem::path(folder / "plain") / "surface.vtp").find("K*/K"),
            std::string::npos);
  const Json report = runJson({"export", scene, "-o", folder / "asked", "--stability"});
  const std::string vtp = text(std::filesystem::path(folder / "asked") / "surface.vtp");
  EXPECT_NE(vtp.find("\"stability [K*/K]\""), std::string::npos);
  EXPECT_NE(vtp.find("\"least stiffness [N/m]\""), std::string::npos);
  EXPECT_FALSE(report.at("stability").at("device_given").asBool());
  EXPECT_NEAR(report.at("stability").at("ratio_min").asNumber(), 0.5, 0.01);
}

} // namespace
} // namespace patina::test
