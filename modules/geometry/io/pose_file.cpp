#include "geometry/io/pose_file.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "core/utf8.h"
#include "geometry/io/text_scan.h"

namespace patina {
namespace {

struct PoseFault {
  int row; // zero-based
  std::string cause;
};

// Returns why these numbers are not a rigid motion.
std::optional<PoseFault> faultOf(const Eigen::Matrix4d& pose, double rigid = kRigid) {
  for (int row = 0; row < 4; ++row)
    if (!pose.row(row).allFinite()) return PoseFault{row, "not finite"};
  if (pose.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    return PoseFault{3, "the last row of a pose is 0 0 0 1"};
  const Eigen::Matrix3d rotation = pose.topLeftCorner<3, 3>();
  for (int row = 0; row < 3; ++row)
    if (const double length = rotation.row(row).norm(); std::abs(length - 1) > rigid)
      return PoseFault{row, "this row of the rotation has the length " + formatNumber(length) +
                                ", not 1: a pose may not scale"};
  if (!((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < rigid))
    return PoseFault{0, "the rotation's rows are not at right angles"};
  if (rotation.determinant() < 0) return PoseFault{0, "a reflection, not a rotation"};
  return std::nullopt;
}

} // namespace

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
  text::Lines lines(withoutByteOrderMark(whole));
  std::vector<double> values;
  std::vector<std::size_t> line_of;
  const auto refuse = [&](std::size_t line, const std::string& cause) {
    throw FileError(name, line, cause);
  };
  for (std::string_view line; lines.next(line);) {
    text::Words words(line.substr(0, line.find('#')));
    for (auto word = words.next(); !word.empty(); word = words.next()) {
      const std::optional<double> value = parseNumber(word);
      if (!value || !std::isfinite(*value))
        refuse(lines.number(), text::quoted(word) + " is not a number");
      if (values.size() == kNumbers)
        refuse(lines.number(), "a pose ends after 4 x 4 numbers; here is one more");
      values.push_back(*value);
      line_of.push_back(lines.number());
    }
  }
  if (values.size() != kNumbers)
    refuse(lines.number(),
           "the file ends after " + std::to_string(values.size()) + " numbers; a pose has 4 x 4");
  const Eigen::Matrix4d pose = Eigen::Map<const Eigen::Matrix4d>(values.data()).transpose();
  if (const auto fault = faultOf(pose))
    refuse(line_of[static_cast<std::size_t>(4 * fault->row)], fault->cause);
  return Pose(pose);
}

Json poseJson(const Pose& pose) {
  const Eigen::Matrix4d m = pose.matrix();
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row)
    rows.push(Json(Json::Array{m(row, 0), m(row, 1), m(row, 2), m(row, 3)}));
  return rows;
}

Pose poseIn(const Json& object, const std::string& key, double rigid) {
  const auto refuse = [&](int row, const std::string& cause) {
    throw Error("'" + key + "', row " + std::to_string(row + 1) + ": " + cause);
  };
  const Json::Array& rows = object.at(key).asArray();
  if (rows.size() != 4) throw Error("'" + key + "' has not four rows");
  Eigen::Matrix4d pose;
  for (int i = 0; i < 4; ++i) {
    const Json::Array& row = rows[static_cast<std::size_t>(i)].asArray();
    if (row.size() != 4) refuse(i, "has not four numbers");
    for (int k = 0; k < 4; ++k) pose(i, k) = row[static_cast<std::size_t>(k)].asNumber();
  }
  if (const auto fault = faultOf(pose, rigid)) refuse(fault->row, fault->cause);
  return Pose(pose);
}

Pose readPoseAt(const std::filesystem::path& path, const std::string& key) try {
  return poseIn(parseJson(readFile(path), path.string()), key);
} catch (const FileError&) {
  throw;
} catch (const Error& error) {
  throw FileError(path.string(), 0, error.what());
}

} // namespace patina
