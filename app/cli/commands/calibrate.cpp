#include <algorithm>
#include <cmath>
#include <cstdio>

#include "acquisition/calibration/calibrate_camera.h"
#include "acquisition/calibration/force_fit.h"
#include "acquisition/calibration/pivot.h"
#include "acquisition/calibration/still_probe.h"
#include "acquisition/files/measured.h"
#include "acquisition/files/scan_files.h"
#include "acquisition/sources/sources.h"
#include "app/cli/commands/commands.h"
#include "app/cli/input/input_files.h"
#include "app/cli/output/reports.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"

namespace patina::cli {

namespace {

constexpr double kMostGain = 0.05; // by which an accelerometer's may differ from 1

struct CalibrateOptions {
  std::filesystem::path input, rig, output;
  std::optional<Board> board;
  std::string board_text;
  bool still = false, force = false;
  double rate = 0;
};

const Keys kParameterParts = {{"value", "", ""}, {"deviation", "", ""}};
const Keys kCalibrateKeys = {
    {"rms_px", "px", "corners miss by", "rms of an image's two axes together"},
    {"rms", "m", "tip misses by", "rms of its distance from where it stood"},
    {"rms_acceleration", "m/s^2", "readings miss by", "rms of an axis, of the probe held still"},
    {"rms_force", "N", "forces miss by", "rms of the readings that were used"},
    {"views", "", "used", "views, poses, attitudes held still, or readings"},
    {"rejected", "", "rejected",
     "views without the board, or poses or readings that contradict the others"},
    {"unlike", "", "not needed", "views of a video or camera that are blurred or like others",
     Shown::if_any},
    {"frames", "", "frames", "of the pictures, the video or the camera", Shown::never},
    {"axis_deviation", "rad", "axes within", "standard deviation of the least known direction",
     Shown::if_any},
    {"parameters", "", "parameters",
     "by name: fx fy cx cy k1 k2 p1 p2 k3 of a camera; x y z of a tip [m]; "
     "of a probe held still a1u a1v a2u a2v, the biases [m/s^2], and force_zero [N]; force_zero "
     "and force_gain of known weights",
     Shown::never, kParameterParts}};

void tellParameter(Json& parameters, Report& report, const std::string& name, double value,
                   double deviation, double shown_in, const std::string& unit) {
  Json json = Json::object();
  parameters.set(name, json.set("value", value).set("deviation", deviation));
  // Two digits of the deviation, and of the value no digit beyond them.
  const bool known = deviation > 0 && std::isfinite(deviation);
  const int behind =
      known ? std::clamp(1 - static_cast<int>(std::floor(std::log10(deviation * shown_in))), 0, 12)
            : 6;
  const auto text = [&](double number) {
    char digits[400];
    std::snprintf(digits, sizeof digits, "%.*f", behind, number * shown_in);
    return std::string(digits);
  };
  report.tell(name, text(value) + " +- " + text(deviation) + unit);
}

int reportCamera(const CalibrateOptions& options, Console& console) {
  const std::string from = options.input.string();
  // Nobody needs to know when pictures were taken.
  const double rate = std::filesystem::is_directory(options.input) ? 1 : 0;
  const auto frames = openFrames(from, options.rate > 0 ? options.rate : rate);
  const CalibratedCamera found =
      calibrateCamera(*frames, *options.board, options.board_text, from, console.progress());
  Report report(kCalibrateKeys);
  report.set("rms_px", found.fit.rms, rounded(found.fit.rms) + " px");
  report.set("views", found.views,
             formatCount(found.views) + " of " + formatCount(found.frames) + " frames");
  report.set("rejected", found.rejected.size()).set("unlike", found.unlike);
  report.set("frames", found.frames);
  Json parameters = Json::object();
  for (std::size_t i = 0; i < 9; ++i)
    tellParameter(parameters, report, kCameraParameters[i], parametersOf(found.fit.camera)[i],
                  found.fit.deviation[i], 1, i < 4 ? " px" : "");
  report.set("parameters", parameters);
  for (const std::string& line : found.notes) console.warn(line);
  if (!found.doubt.empty()) {
    console.warn(found.doubt + "; nothing is written");
    return console.report(report, kNotSolved);
  }
  writeFileAtomically(options.output, calibratedText(found.fit, options.board_text));
  if (!found.first_rejected.empty())
    console.warn(found.first_rejected + ": the board is not seen" +
                 (found.rejected.size() > 1
                      ? ", nor in " + formatCount(found.rejected.size() - 1) + " others"
                      : ""));
  return console.report(report);
}

int calibrateTip(const CalibrateOptions& options, Console& console) {
  const OnFile<CameraPose> poses = readPoses(options.input);
  const std::string rig = options.rig.empty() ? "{}" : readFile(options.rig);
  const PivotFit fit = tipOf(poses.values, options.input.string());
  Report report(kCalibrateKeys);
  report.set("rms", fit.rms).set("views", poses.values.size() - fit.rejected);
  report.set("rejected", fit.rejected);
  Json parameters = Json::object();
  for (int i = 0; i < 3; ++i)
    tellParameter(parameters, report, std::string(1, static_cast<char>('x' + i)), fit.tip[i],
                  std::sqrt(fit.covariance(i, i)), 1e3, " mm");
  report.set("parameters", parameters);
  writeFileAtomically(options.output, rigWithTip(rig, options.rig.string(), fit));
  return console.report(report);
}

int calibrateStill(const CalibrateOptions& options, Console& console) {
  const OnFile<CameraPose> poses = readPoses(options.input / "poses.tum");
  std::vector<std::string> warnings;
  const OnFile<ProbeSample> samples = readProbeStream(options.input / "probe.csv", &warnings);
  for (const std::string& line : warnings) console.warn(line);
  Json json = Json::object();
  Rig rig;
  if (!options.rig.empty()) {
    rig = readRig(options.rig);
    json = parseJson(readFile(options.rig), options.rig.string());
  }
  const auto fit = fitStillProbe(poses.values, samples.values, rig.probe);
  if (!fit)
    throw FileError(
        options.input.string(), 0,
        "there are too few attitudes in which the probe was held still, or they are too "
        "alike: half a second each, in the air, eight at least, leaning to all sides");
  constexpr const char* kAxes[] = {"a1u", "a1v", "a2u", "a2v"};
  for (std::size_t k = 0; k < 4; ++k)
    if (!(std::abs(fit->gain[k] - 1) < kMostGain))
      throw FileError((options.input / "probe.csv").string(), 0,
                      std::string(kAxes[k]) + ": gravity reads " + rounded(9.80665 * fit->gain[k]) +
                          " where it is 9.81: tell the accelerations in m/s^2");
  Report report(kCalibrateKeys);
  report.set("rms_acceleration", fit->rms).set("views", fit->attitudes);
  report.set("axis_deviation", *std::max_element(fit->deviation.begin(), fit->deviation.end()));
  Json axes = Json::object(), parameters = Json::object();
  for (std::size_t k = 0; k < 4; ++k) {
    tellParameter(parameters, report, kAxes[k], fit->bias[k], fit->bias_deviation[k], 1, " m/s^2");
    Json axis = Json::object();
    axis.set("position", vectorJson(rig.probe.axes[k].position));
    axes.set(kAxes[k], axis.set("direction", vectorJson(fit->directions[k])));
  }
  tellParameter(parameters, report, "force_zero", fit->force_zero,
                std::sqrt(rig.probe.forceVariance()), 1, " N");
  report.set("parameters", parameters);
  if (options.rig.empty()) {
    console.warn("without --rig the places of tip and accelerometers are those of a common probe");
    json.set("tip", vectorJson(rig.probe.tip));
  }
  json.set("accelerometers", axes).set("gravity", vectorJson(fit->gravity));
  json.set("force_zero", fit->force_zero);
  writeFileAtomically(options.output, json.dump() + "\n");
  return console.report(report);
}

int calibrateForce(const CalibrateOptions& options, Console& console) {
  CsvReader table(options.input, {{"force [N]", "reading"}});
  std::vector<KnownForce> readings;
  std::vector<std::size_t> lines;
  for (std::vector<double> row; table.next(row);) {
    requireMeasured(row[0], "force [N]", options.input.string(), table.line());
    requireMeasured(row[1], "reading", options.input.string(), table.line());
    readings.push_back({row[0], row[1]});
    lines.push_back(table.line());
  }
  console.warn(table.leftOut());
  Json json = Json::object();
  if (!options.rig.empty()) {
    (void)readRig(options.rig);
    json = parseJson(readFile(options.rig), options.rig.string());
  }
  const auto fit = fitForce(readings);
  if (!fit)
    throw FileError(options.input.string(), 0,
                    "the readings do not tell zero and gain: four at least, of three forces, that "
                    "grow with the force");
  Report report(kCalibrateKeys);
  report.set("rms_force", fit->rms).set("views", readings.size() - fit->rejected.size());
  report.set("rejected", fit->rejected.size());
  Json parameters = Json::object();
  tellParameter(parameters, report, "force_zero", fit->zero, fit->zero_deviation, 1, "");
  tellParameter(parameters, report, "force_gain", fit->gain, fit->gain_deviation, 1, "");
  report.set("parameters", parameters);
  if (options.rig.empty()) {
    console.warn("without --rig the tip is that of a common probe");
    json.set("tip", vectorJson(ProbeModel().tip));
  }
  json.set("force_zero", fit->zero).set("force_gain", fit->gain);
  json.set("force_zero_deviation", fit->zero_deviation);
  json.set("force_gain_deviation", fit->gain_deviation);
  writeFileAtomically(options.output, json.dump() + "\n");
  if (!fit->rejected.empty())
    console.warn(options.input.string() + ":" + std::to_string(lines[fit->rejected[0]]) +
                 ": contradicts the other readings" +
                 (fit->rejected.size() > 1
                      ? ", as do " + formatCount(fit->rejected.size() - 1) + " more"
                      : ""));
  return console.report(report);
}

int runCalibrate(const CalibrateOptions& options, Console& console) {
  requireWritable(options.output, {options.input}, options.board ? FileKind::yaml : FileKind::json);
  if (options.board && options.still) throw Error("--still: not with --board");
  if (options.force && (options.board || options.still))
    throw Error("--force: not with --board or --still");
  if (options.force) return calibrateForce(options, console);
  if (options.board) return reportCamera(options, console);
  return options.still ? calibrateStill(options, console) : calibrateTip(options, console);
}

} // namespace

Command calibrateCommand() {
  auto options = std::make_shared<CalibrateOptions>();
  return {
      .name = "calibrate",
      .summary = "a camera from views of a board, a probe's tip or its accelerometers",
      .description =
          "With --board INPUT is a folder of pictures, a video, camera:0 and so on, or "
          "replay:SCAN, "
          "and CAMERA.yml gets what OpenCV calls camera_matrix and distortion_coefficients, with "
          "the deviation of each. Views without the board are named and left out. Of pictures all "
          "are used; of a video or a camera at most 60 frames that are sharp and show the board in "
          "different places: a camera is read until there are as many, or until Ctrl-C. Both "
          "layouts of ChArUco boards are known, that of OpenCV before 4.6 and that since. Where "
          "corners miss by more than 1.5 px nothing is written, and the exit code is 1.\n"
          "With --still INPUT is a scan folder (poses.tum, probe.csv) of a probe that was held "
          "still in "
          "the air, leaning to all sides, and RIG.json gets the accelerometers' axes, gravity and "
          "the force's zero; --rig tells the axes roughly.\n"
          "With neither, INPUT is a file of poses while the probe's tip stood still and the probe "
          "turned about it to all sides, and RIG.json gets the tip, beside what --rig holds. "
          "Poses that contradict the others are left out.",
      .examples = {"patina calibrate views --board chessboard:9x6:25mm -o camera.yml",
                   "patina calibrate views --board charuco:5x7:40mm:20mm:6x6_250 -o camera.yml",
                   "patina calibrate board.mp4 --board chessboard:9x6:25mm -o camera.yml",
                   "patina calibrate turning.tum --rig rig.json -o rig-with-tip.json",
                   "patina calibrate held --still --rig rig-with-tip.json -o rig-of-probe.json",
                   "patina calibrate weights.csv --force --rig rig.json -o rig-with-force.json"},
      .keys = kCalibrateKeys,
      .arguments =
          {input("INPUT",
                 "Folder of pictures, video, camera:N, replay:SCAN, scan folder, poses as TUM, or "
                 "weights.",
                 Setter([options](const std::string& text) { options->input = text; },
                        filesOfSource)),
           outputTo(options->output, "FILE", "CAMERA.yml, or RIG.json."),
           {"--board", "BOARD", "", "",
            "chessboard:COLUMNSxROWS:SQUARE, counted in inner corners, or "
            "charuco:COLUMNSxROWS:SQUARE:MARKER:FAMILY, counted in squares.",
            [options](const std::string& text) {
              options->board = parseBoard(text);
              options->board_text = text;
            }},
           {"--rate", "HZ", "Hz", "",
            "Frames a second of a video that does not say when they were taken.",
            inRange(1e-3, 1e5, [options](double rate) { options->rate = rate; })},
           {"--still", "", "", "", "The accelerometers of a probe held still.",
            into(options->still)},
           {"--force", "", "", "",
            "INPUT is a table of known weights and readings (force [N],reading).",
            into(options->force)},
           {"--rig", "RIG.json", "", "", "What else RIG.json is to hold.", into(options->rig)}},
      .run = [options](Console& console) { return runCalibrate(*options, console); }};
}

} // namespace patina::cli
