#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <sstream>

#include "acquisition/files/measured.h"
#include "acquisition/files/scan_tables.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/file.h"
#include "core/line_buffer.h"
#include "core/numbers.h"
#include "core/utf8.h"

namespace patina {
namespace {

constexpr double kUnit = 0.01;      // accepted deviation of a quaternion's length from 1
constexpr double kRounding = 1e-12; // deviation of a unit length that is due to rounding

constexpr std::string_view kRigDoubt = "# rig: ";

const std::vector<std::string> kColumns = {
    "t [s]", "tx [m]", "ty [m]", "tz [m]",    "qx",
    "qy",    "qz",     "qw",     "sigma [m]", "sigma_angle [rad]"};

double measuredIn(const std::string& word, std::size_t column, const std::string& name,
                  std::size_t line) {
  if (word.find(',') != std::string::npos)
    throw FileError(name, line, "decimal commas: write numbers with a point, spaces between them");
  const std::optional<double> value = parseNumber(word);
  if (!value) throw FileError(name, line, "'" + word.substr(0, 40) + "' is not a finite number");
  requireMeasured(*value, kColumns[column], name, line);
  return *value;
}

// Returns true if the first line that is not a comment is a table's header.
bool startsWithName(std::string_view text) {
  text = withoutByteOrderMark(text);
  while (!text.empty()) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return false;
    text.remove_prefix(first);
    if (text.front() != '#' && text.front() != '%') break;
    text.remove_prefix(std::min(text.find_first_of("\r\n"), text.size()));
  }
  const std::string_view word = text.substr(0, text.find_first_of(" \t,;"));
  return !text.empty() && !parseNumber(word) &&
         (text.front() == '"' || std::isalpha(static_cast<unsigned char>(text.front())));
}

// Appends a pose of 8 or 10 values; throws FileError.
void addPose(const std::vector<double>& values, const PoseSigmas& default_sigmas,
             const std::string& name, std::size_t line, OnFile<CameraPose>& file) {
  CameraPose pose;
  pose.t = values[0];
  pose.position = {values[1], values[2], values[3]};
  pose.orientation = Eigen::Quaterniond(values[7], values[4], values[5], values[6]);
  pose.sigma_position = values.size() > 8 ? values[8] : default_sigmas.position;
  pose.sigma_angle = values.size() > 8 ? values[9] : default_sigmas.angle;
  if (!(std::abs(pose.orientation.norm() - 1) < kUnit))
    throw FileError(name, line,
                    "the quaternion's length is " + formatNumber(pose.orientation.norm()) +
                        ", not 1");
  // A quaternion that this program wrote has length 1 up to rounding and keeps its bits.
  if (std::abs(pose.orientation.norm() - 1) > kRounding) pose.orientation.normalize();
  if (!(pose.sigma_position > 0 && pose.sigma_angle > 0))
    throw FileError(name, line, "deviations must be above 0");
  if (!file.values.empty() && !(pose.t > file.values.back().t))
    throw FileError(name, line,
                    pose.t == file.values.back().t ? "time repeats" : "time runs backwards");
  file.values.push_back(pose);
  file.lines.push_back(line);
}

std::string lineOf(const CameraPose& pose) {
  std::string text = formatNumber(pose.t);
  for (const double value : pose.position) text += " " + formatNumber(value);
  for (const double value : pose.orientation.coeffs()) text += " " + formatNumber(value);
  return text;
}

} // namespace

OnFile<CameraPose> readPoses(const std::filesystem::path& path, const PoseSigmas& default_sigmas,
                             std::vector<std::string>* warnings) {
  // A pose takes about 150 bytes, so this limit is a day of a camera.
  constexpr std::uintmax_t kMostBytes = 500'000'000;
  std::error_code unknown;
  if (const auto size = std::filesystem::file_size(path, unknown); !unknown && size > kMostBytes)
    throw FileError(path.string(), 0,
                    "is larger than any scan's poses: " + formatBytes(static_cast<double>(size)));
  return parsePoses(readFile(path), path.string(), default_sigmas, warnings);
}

OnFile<CameraPose> parsePoses(const std::string& whole, const std::string& name,
                              const PoseSigmas& default_sigmas,
                              std::vector<std::string>* warnings) {
  OnFile<CameraPose> file;
  if (startsWithName(whole)) {
    const std::vector<std::string> required(kColumns.begin(), kColumns.begin() + 8);
    CsvReader reader(sourceOfText(whole), name, {required, {kColumns[8], kColumns[9]}});
    warnOfColumns(reader, warnings);
    if (reader.has(kColumns[8]) != reader.has(kColumns[9]))
      throw FileError(name, 1, "'sigma [m]' and 'sigma_angle [rad]' go together");
    for (std::vector<double> row; reader.next(row);) {
      if (!reader.has(kColumns[8])) row.resize(required.size());
      for (std::size_t i = 0; i < row.size(); ++i)
        requireMeasured(row[i], kColumns[i], name, reader.line());
      addPose(row, default_sigmas, name, reader.line(), file);
    }
  } else {
    LineBuffer lines;
    lines.append(withoutByteOrderMark(whole));
    bool rig_doubted = false;
    std::size_t number = 0;
    for (std::string_view line; lines.next(line, true);) {
      ++number;
      rig_doubted = rig_doubted || line.starts_with(kRigDoubt);
      if (warnings && line.starts_with(kRigDoubt)) {
        std::string doubt(line.substr(kRigDoubt.size()));
        while (!doubt.empty() && doubt.back() == '\r') doubt.pop_back();
        warnings->push_back(name + ": of the rig's markers: " + doubt);
      }
      std::istringstream words{std::string(line.substr(0, line.find_first_of("#%")))};
      const std::vector<std::string> word{std::istream_iterator<std::string>(words), {}};
      if (word.empty()) continue;
      if (word.size() != 8 && word.size() != kColumns.size())
        throw FileError(name, number,
                        std::to_string(word.size()) +
                            " numbers where t tx ty tz qx qy qz qw are due, or two more");
      std::vector<double> values;
      for (const std::string& each : word)
        values.push_back(measuredIn(each, values.size(), name, number));
      addPose(values, default_sigmas, name, number, file);
    }
    for (CameraPose& pose : file.values) pose.rig_doubted = rig_doubted;
  }
  if (file.values.empty()) throw FileError(name, 0, "there is no pose in it");
  return file;
}

void writePoses(const std::filesystem::path& path, const std::vector<CameraPose>& poses) {
  std::string text = "# t [s] tx ty tz [m] qx qy qz qw\n";
  for (const CameraPose& pose : poses) text += lineOf(pose) + "\n";
  writeFileAtomically(path, text);
}

std::string posesHeader() {
  return "# t [s] tx ty tz [m] qx qy qz qw sigma [m] sigma_angle [rad]\n";
}

std::string poseRow(const CameraPose& pose) {
  return lineOf(pose) + " " + formatNumber(pose.sigma_position) + " " +
         formatNumber(pose.sigma_angle) + "\n";
}

std::string poseRow(const MissingPose& without) {
  return "# " + formatNumber(without.t) + " no pose: " + without.why + "\n";
}

std::string posesText(const std::vector<CameraPose>& poses, const std::vector<MissingPose>& without,
                      const std::string& rig_doubt) {
  std::string text = posesHeader();
  if (!rig_doubt.empty()) text += std::string(kRigDoubt) + rig_doubt + "\n";
  auto gap = without.begin();
  for (const CameraPose& pose : poses) {
    for (; gap != without.end() && gap->t < pose.t; ++gap) text += poseRow(*gap);
    text += poseRow(pose);
  }
  for (; gap != without.end(); ++gap) text += poseRow(*gap);
  return text;
}

void writePoses(const std::filesystem::path& path, const std::vector<CameraPose>& poses,
                const std::vector<MissingPose>& without, const std::string& rig_doubt) {
  writeFileAtomically(path, posesText(poses, without, rig_doubt));
}

} // namespace patina
