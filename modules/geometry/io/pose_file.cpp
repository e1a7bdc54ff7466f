#include "geometry/io/pose_file.h"

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/json.h"
#include "core/numbers.h"

namespace patina {

Pose readPose(const std::filesystem::path& path) {
  return parsePose(readFile(path), path.string());
}

std::string poseText(const Pose& pose, const std::string& frames) {
  std::string text = "# " + frames + "\n";
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      text += formatNumber(pose.matrix()(row, column)) + (column < 3 ? " " : "\n");
  return text;
}

Pose parsePose(const std::string& whole, const std::string& name) {
  constexpr std::size_t kNumbers = 16;
  std::istringstream text(whole);
  std::vector<double> values;
  std::vector<std::size_t> line_of;
  std::size_t line_number = 0;
  const auto refuse = [&](std::size_t line, const std::string& cause) {
    throw FileError(name, line, cause);
  };
  for (std::string line; std::getline(text, line);) {
    ++line_number;
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;) {
      const std::optional<double> value = parseNumber(word);
      if (!value || !std::isfinite(*value)) refuse(line_number, "'" + word + "' is not a number");
      if (values.size() == kNumbers)
        refuse(line_number, "a pose ends after 4 x 4 numbers; here is one more");
      values.push_back(*value);
      line_of.push_back(line_number);
    }
  }
  if (values.size() != kNumbers)
    refuse(line_number,
           "the file ends after " + std::to_string(values.size()) + " numbers; a pose has 4 x 4");
  Pose pose;
  for (std::size_t i = 0; i < kNumbers; ++i)
    pose.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = values[i];
  if (pose.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    refuse(line_of[12], "the last row of a pose is 0 0 0 1");
  constexpr double kRigid = 1e-6;
  for (int row = 0; row < 3; ++row)
    if (std::abs(pose.linear().row(row).norm() - 1) > kRigid)
      refuse(line_of[static_cast<std::size_t>(4 * row)],
             "this row of the rotation has the length " +
                 formatNumber(pose.linear().row(row).norm()) + ", not 1: a pose may not scale");
  const Eigen::Matrix3d rotation = pose.linear();
  if (!((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < kRigid))
    refuse(line_of[0], "the rotation's rows are not at right angles");
  if (rotation.determinant() < 0) refuse(line_of[0], "a reflection, not a rotation");
  return pose;
}

Pose readPoseAt(const std::filesystem::path& path, const std::string& key) try {
  const Json rows = parseJson(readFile(path), path.string()).at(key);
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      matrix(i, j) = rows.asArray()
                         .at(static_cast<std::size_t>(i))
                         .asArray()
                         .at(static_cast<std::size_t>(j))
                         .asNumber();
  return Pose(matrix);
} catch (const FileError&) {
  throw;
} catch (const std::exception& error) {
  throw FileError(path.string(), 0, key + ": " + error.what());
}

} // namespace patina
