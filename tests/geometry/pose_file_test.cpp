// A pose in a text file and in JSON: both reject the same numbers.
#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/io/pose_file.h"

namespace patina {
namespace {

Pose somePose() {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  pose.translation() = Vec3(0.1, -0.2, 0.3);
  return pose;
}

TEST(PoseFile, TextAndJsonReadBackBitForBit) {
  const Pose pose = somePose();
  EXPECT_EQ(parsePose(poseText(pose, "a"), "a").matrix(), pose.matrix());
  EXPECT_EQ(parsePose("\xEF\xBB\xBF" + poseText(pose, "a"), "a").matrix(), pose.matrix());
  EXPECT_EQ(poseIn(Json::object().set("a", poseJson(pose)), "a").matrix(), pose.matrix());
}

TEST(PoseFile, NonRigidMotionsAreRejectedByRowInTextAndJson) {
  struct Case {
    Eigen::Matrix4d pose;
    int row;
    const char* cause;
  };
  const Eigen::Matrix4d good = somePose().matrix();
  std::vector<Case> cases(4, {good, 1, ""});
  cases[0].pose(3, 2) = 1, cases[0].row = 4, cases[0].cause = "the last row";
  cases[1].pose.row(1).head<3>() *= 1.01, cases[1].row = 2, cases[1].cause = "may not scale";
  cases[2].pose.row(2).head<3>() *= -1, cases[2].cause = "a reflection";
  cases[3].pose.row(1) = good.row(0), cases[3].cause = "right angles";
  const auto saysOf = [](const auto& read) -> std::string {
    try {
      read();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.cause);
    Pose pose;
    pose.matrix() = each.pose;
    const Json json = Json::object().set("key", poseJson(pose));
    const std::string text = saysOf([&] { parsePose(poseText(pose, "frames"), "file"); }),
                      in_json = saysOf([&] { poseIn(json, "key"); });
    EXPECT_NE(text.find(each.cause), std::string::npos) << text;
    EXPECT_NE(text.find("file:" + std::to_string(each.row + 1)), std::string::npos) << text;
    EXPECT_NE(in_json.find(each.cause), std::string::npos) << in_json;
    EXPECT_NE(in_json.find("'key', row " + std::to_string(each.row)), std::string::npos) << in_json;
  }
  const Json ragged = parseJson("{\"key\": [[1, 0], [], [], []], \"few\": [[]]}", "file");
  EXPECT_NE(saysOf([&] { poseIn(ragged, "key"); }).find("row 1"), std::string::npos);
  EXPECT_NE(saysOf([&] { poseIn(ragged, "few"); }).find("four rows"), std::string::npos);
}

} // namespace
} // namespace patina
