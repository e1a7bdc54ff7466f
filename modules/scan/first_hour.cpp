#include "scan/first_hour.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <vector>

#include "acquisition/files/camera_file.h"
#include "acquisition/files/scan_tables.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "core/output_target.h"
#include "scan/print_rig.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr double kKnownScale =
    4e-3; // relative deviation of sizes above which one is to be measured

std::string decimals(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

// The path as a word of a shell.
std::string wordOf(const fs::path& path) {
  const std::string text = path.string();
  const bool plain = std::ranges::all_of(text, [](unsigned char c) {
    return c >= 0x80 || std::isalnum(c) ||
           std::string("/._-+:").find(static_cast<char>(c)) != std::string::npos;
  });
  if (plain) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

// A recording in a subfolder.
struct Recording {
  fs::path folder;
  fs::file_time_type time;
  std::size_t frames = 0;
  bool tip_known = false; // its own rig.json has the tip's deviation
};

std::vector<Recording> recordingsIn(const fs::path& folder) {
  std::vector<Recording> found;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const fs::path list = entry.path() / "frames.csv", rig = entry.path() / "rig.json";
    if (!fs::is_regular_file(list, none) || !fs::is_regular_file(rig, none)) continue;
    try {
      const std::string text = readFile(list);
      const auto rows = static_cast<std::size_t>(std::ranges::count(text, '\n'));
      found.push_back({entry.path(), fs::last_write_time(list), rows > 0 ? rows - 1 : 0,
                       parseRigDeviations(readFile(rig), rig.string()).tip.has_value()});
    } catch (const std::exception&) {
      continue; // it is no recording of this rig; opening it as a scan tells why
    }
  }
  std::ranges::sort(found, {}, &Recording::time);
  return found;
}

FirstHourStep cameraStep(const fs::path& file) {
  if (!pathExists(file)) return {false, "", "photograph the printed board with the camera"};
  try {
    const std::string text = readFile(file), key = "avg_reprojection_error:";
    const Camera camera = parseCamera(text, file.string());
    std::string figure = std::to_string(camera.width) + " x " + std::to_string(camera.height);
    if (const std::size_t at = text.find(key); at != std::string::npos) {
      const std::size_t begin = text.find_first_not_of(' ', at + key.size());
      if (const auto rms = parseNumber(text.substr(begin, text.find('\n', begin) - begin)))
        figure = decimals(*rms, 2) + " px rms, " + figure;
    }
    return {true, figure, ""};
  } catch (const std::exception& error) {
    return {false, "", error.what()};
  }
}

} // namespace

fs::path freshPath(const fs::path& folder, const std::string& name) {
  fs::path path = folder / name;
  for (int number = 2; pathExists(path); ++number)
    path = folder / (name + "-" + std::to_string(number));
  return path;
}

FirstHour readFirstHour(const fs::path& folder) {
  FirstHour hour;
  hour.board = boardBeside("");
  const fs::path rig = folder / "rig.json", camera = folder / "camera.yml";
  const std::string into = " -o " + wordOf(folder);
  hour.print.remedy = "print the sheets and glue the rig";
  hour.wave.remedy =
      "wave the rig before the camera, turn it about its tip in a dimple, lay it down";
  RigDeviations known;
  if (pathExists(rig)) {
    try {
      const std::string text = readFile(rig);
      const std::vector<RigMarker> markers = parseMarkers(text, rig.string());
      known = parseRigDeviations(text, rig.string());
      hour.board = boardBeside(markers.front().family);
      hour.print = {
          true, formatCount(markers.size()) + " markers of " + formatLength(markers.front().size),
          ""};
    } catch (const std::exception& error) {
      hour.print.remedy = error.what();
    }
  }
  if (known.tip) {
    hour.wave = {true, "tip +- " + decimals(1e3 * *known.tip, 3) + " mm", ""};
    if (known.size.value_or(0) > kKnownScale)
      hour.wave.remedy = "the scale is known to " + decimals(100 * *known.size, 1) +
                         " % only: measure the black square of a marker";
  } else if (known.calibrated) {
    hour.wave.remedy = "the tip is not known: turn the rig about it in a dimple";
  }
  hour.photograph = cameraStep(camera);
  hour.scan.remedy = "record a scan";
  std::size_t scans = 0;
  for (const Recording& recording : recordingsIn(folder)) {
    if (!recording.tip_known) {
      hour.waved = recording.folder;
      continue;
    }
    ++scans;
    hour.scan = {true,
                 formatCount(scans) + (scans == 1 ? " scan, " : " scans, the newest ") +
                     recording.folder.filename().string() + " of " + formatCount(recording.frames) +
                     " frames",
                 ""};
  }
  if (!hour.wave.done && !hour.waved.empty())
    hour.wave.remedy = hour.waved.filename().string() + " is recorded: calibrate the rig from it";

  if (!hour.print.done)
    hour.command = "patina rig print" + into;
  else if (!hour.photograph.done)
    hour.command = "patina calibrate camera:0 --board " + hour.board + " -o " + wordOf(camera);
  else if (!hour.wave.done && !hour.waved.empty())
    hour.command =
        "patina calibrate " + wordOf(hour.waved) + " --length " + "0=SIZE -o " + wordOf(rig);
  else if (!hour.wave.done || !hour.scan.done)
    hour.command = "patina record camera:0 --camera " + wordOf(camera) + " --rig " + wordOf(rig) +
                   (hour.wave.done ? "" : " --seconds 60") + " -o " +
                   wordOf(freshPath(folder, hour.wave.done ? "scan" : "wave"));
  return hour;
}

} // namespace patina
