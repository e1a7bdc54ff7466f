#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "acquisition/files/camera_file.h"
#include "app/cli/commands/commands.h"
#include "app/cli/input/input_files.h"
#include "app/cli/input/scan_input.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "scan/calibrate.h"

namespace patina::cli {

namespace {

struct CalibrateOptions {
  std::filesystem::path input, rig, output, camera_file, refined;
  CameraCalibrationOptions camera;
  RigCalibrationOptions waved;
  bool board = false, still = false, force = false;
};

const Keys kParameterParts = {{"value", "", ""}, {"deviation", "", ""}};
const Keys kCalibrateKeys = {
    {"rms_px", "px", "corners miss by", "rms of an image's two axes together"},
    {"rms_before_px", "px", "before", "the same with the rig as it was", Shown::if_any},
    {"rms", "m", "tip misses by", "rms of its distance from where it stood"},
    {"rms_acceleration", "m/s^2", "readings miss by", "rms of an axis, of the probe held still"},
    {"rms_force", "N", "forces miss by", "rms of the readings that were used"},
    {"views", "", "used", "views, poses, attitudes held still, or readings"},
    {"rejected", "", "rejected",
     "views without the board, or poses or readings that contradict the others"},
    {"unlike", "", "not needed",
     "views of a video or camera that are blurred, small or like others", Shown::if_any},
    {"frames", "", "frames", "of the pictures, the video or the camera", Shown::never},
    {"axis_deviation", "rad", "axes within", "standard deviation of the least certain direction",
     Shown::if_any},
    {"parameters", "", "parameters",
     "by name: fx fy cx cy k1 k2 p1 p2 k3 of a camera; x y z of a tip [m]; print_scale of a rig, "
     "found sizes over those of rig.json; "
     "of a probe held still a1u a1v a2u a2v, the biases [m/s^2], and force_zero [N]; force_zero "
     "and force_gain of known weights",
     Shown::never, kParameterParts},
    {"markers",
     "",
     "marker",
     "of a rig: where each lies beside its place in rig.json",
     Shown::always,
     {{"id", "", ""},
      {"shift", "m", ""},
      {"shift_deviation", "m", ""},
      {"turn", "rad", ""},
      {"turn_deviation", "rad", ""},
      {"size", "m", ""},
      {"size_deviation", "m", ""},
      {"views", "", ""},
      {"finding", "", "what is wrong with it"}}},
    {"held", "", "held", "what the motion does not determine", Shown::never}};

void tellParameter(Json& parameters, Report& report, const std::string& name, double value,
                   double deviation, double shown_in, const std::string& unit) {
  Json json = Json::object();
  parameters.set(name, json.set("value", value).set("deviation", deviation));
  // Two digits of the deviation, and the value to the same place.
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

RigText rigOf(const CalibrateOptions& options) {
  return options.rig.empty() ? RigText() : RigText{readFile(options.rig), options.rig.string()};
}

int reportCamera(CalibrateOptions options, Console& console) {
  options.camera.frames = options.input.string();
  const CameraCalibration found = calibrateCamera(options.camera, console.progress());
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
  writeFileAtomically(options.output, found.file);
  if (!found.first_rejected.empty())
    console.warn(found.first_rejected + ": the board is not seen" +
                 (found.rejected.size() > 1
                      ? ", nor in " + formatCount(found.rejected.size() - 1) + " others"
                      : ""));
  return console.report(report);
}

int reportTip(const CalibrateOptions& options, Console& console) {
  const std::vector<CameraPose> poses = readPoses(options.input).values;
  const TipCalibration found = calibrateTip(poses, options.input.string(), rigOf(options));
  Report report(kCalibrateKeys);
  report.set("rms", found.fit.rms).set("views", poses.size() - found.fit.rejected);
  report.set("rejected", found.fit.rejected);
  Json parameters = Json::object();
  for (int i = 0; i < 3; ++i)
    tellParameter(parameters, report, std::string(1, static_cast<char>('x' + i)), found.fit.tip[i],
                  std::sqrt(found.fit.covariance(i, i)), 1e3, " mm");
  report.set("parameters", parameters);
  writeFileAtomically(options.output, found.file);
  return console.report(report);
}

const Keys kMarkerKeys = {{"id", "", "id"},
                          {"shift", "m", "shift"},
                          {"shift_deviation", "m", "", "", Shown::never},
                          {"turn", "rad", "turn"},
                          {"turn_deviation", "rad", "", "", Shown::never},
                          {"size", "m", "size"},
                          {"size_deviation", "m", "", "", Shown::never},
                          {"views", "", "views"},
                          {"finding", "", "finding", "", Shown::if_any}};

Report markerReport(const FittedMarker& found) {
  constexpr double kMicro = 1e6, kMilli = 1e3;
  Report report(kMarkerKeys);
  report.set("id", found.marker.id);
  report.set("shift", found.shift,
             "off by " + rounded(kMilli * found.shift) + " +- " +
                 rounded(kMilli * found.shift_deviation) + " mm");
  report.set("shift_deviation", found.shift_deviation);
  report.set("turn", found.turn,
             rounded(kMilli * found.turn) + " +- " + rounded(kMilli * found.turn_deviation) +
                 " mrad");
  report.set("turn_deviation", found.turn_deviation);
  report.set("size", found.marker.size,
             "size " + formatLength(found.marker.size) + " +- " +
                 rounded(kMicro * found.size_deviation) + " um");
  report.set("size_deviation", found.size_deviation);
  report.set("views", found.views, "in " + formatCount(found.views) + " views");
  return report.set("finding", found.finding);
}

int reportRig(CalibrateOptions options, Console& console) {
  RigCalibrationOptions& waved = options.waved;
  waved.frames = options.input.string();
  options.camera_file = scanFile(options.camera_file, "--camera", "camera.yml", waved.frames);
  options.rig = scanFile(options.rig, "--rig", "rig.json", waved.frames);
  requireWritable(options.output, {options.camera_file}, FileKind::json);
  waved.rate = options.camera.rate;
  waved.camera = readCamera(options.camera_file);
  waved.fit.refine_camera = !options.refined.empty();
  if (waved.fit.refine_camera) requireWritable(options.refined, {options.rig}, FileKind::yaml);
  const RigCalibration found = calibrateRig(waved, rigOf(options), console.progress());
  const RigFit& fit = found.fit;
  Report report(kCalibrateKeys);
  report.set("rms_before_px", fit.rms_before, rounded(fit.rms_before) + " px");
  report.set("rms_px", fit.rms, rounded(fit.rms) + " px");
  report.set("views", fit.views,
             formatCount(fit.views) + " of " + formatCount(found.frames) + " frames");
  report.set("frames", found.frames);
  if (fit.tip) report.set("rms", fit.tip->rms);
  Json parameters = Json::object();
  for (int i = 0; fit.tip && i < 3; ++i)
    tellParameter(parameters, report, std::string(1, static_cast<char>('x' + i)), fit.tip->place[i],
                  std::sqrt(fit.tip->covariance(i, i)), 1e3, " mm");
  tellParameter(parameters, report, "print_scale", fit.print_scale, fit.print_scale_deviation, 1,
                "");
  for (std::size_t i = 0; waved.fit.refine_camera && i < 9; ++i)
    tellParameter(parameters, report, kCameraParameters[i], parametersOf(fit.camera)[i],
                  fit.camera_deviation[i], 1, i < 4 ? " px" : "");
  report.set("parameters", parameters);
  std::vector<Report> markers;
  for (const FittedMarker& marker : fit.markers) markers.push_back(markerReport(marker));
  report.set("markers", markers).set("held", jsonOf(fit.held));
  for (const std::string& line : found.warnings) console.warn(line);
  if (!found.doubt.empty()) {
    console.warn(found.doubt + "; nothing is written");
    return console.report(report, kNotSolved);
  }
  writeFileAtomically(options.output, found.file);
  if (waved.fit.refine_camera) writeFileAtomically(options.refined, cameraText(fit.camera));
  return console.report(report);
}

int reportAxes(const CalibrateOptions& options, Console& console) {
  std::vector<std::string> warnings;
  const AxesCalibration found = calibrateAxes(options.input, rigOf(options), warnings);
  for (const std::string& line : warnings) console.warn(line);
  if (options.rig.empty())
    console.warn("without --rig the places of tip and accelerometers are those of a common probe");
  const AccelerometerCalibration& fit = found.fit;
  Report report(kCalibrateKeys);
  report.set("rms_acceleration", fit.rms).set("views", fit.attitudes);
  report.set("axis_deviation", *std::max_element(fit.deviation.begin(), fit.deviation.end()));
  Json parameters = Json::object();
  for (std::size_t k = 0; k < kAxisNames.size(); ++k)
    tellParameter(parameters, report, kAxisNames[k], fit.bias[k], fit.bias_deviation[k], 1,
                  " m/s^2");
  tellParameter(parameters, report, "force_zero", fit.force_zero,
                std::sqrt(found.probe.forceVariance()), 1, " N");
  report.set("parameters", parameters);
  writeFileAtomically(options.output, found.file);
  return console.report(report);
}

int reportForce(const CalibrateOptions& options, Console& console) {
  std::vector<std::string> warnings;
  const ForceCalibration found = calibrateForce(options.input, rigOf(options), warnings);
  for (const std::string& line : warnings) console.warn(line);
  if (options.rig.empty()) console.warn("without --rig the tip is that of a common probe");
  const ForceFit& fit = found.fit;
  Report report(kCalibrateKeys);
  report.set("rms_force", fit.rms).set("views", found.readings - fit.rejected.size());
  report.set("rejected", fit.rejected.size());
  Json parameters = Json::object();
  tellParameter(parameters, report, "force_zero", fit.zero, fit.zero_deviation, 1, "");
  tellParameter(parameters, report, "force_gain", fit.gain, fit.gain_deviation, 1, "");
  report.set("parameters", parameters);
  writeFileAtomically(options.output, found.file);
  return console.report(report);
}

// Returns true for a folder, a live source or a video, false for a text.
bool isOfFrames(const std::filesystem::path& input) {
  if (!std::filesystem::is_regular_file(input)) {
    const std::string source = input.string();
    return std::filesystem::is_directory(input) || source.starts_with("camera:") ||
           source.starts_with("replay:");
  }
  std::ifstream file(input, std::ios::binary);
  std::string begin(1024, ' ');
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin.find('\0') < static_cast<std::size_t>(file.gcount());
}

MeasuredSize parseMeasuredSize(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto id = parseNumber(text.substr(0, equals));
  if (equals == std::string::npos || !id || *id < 0 || *id != std::floor(*id) || *id > 1e5)
    throw Error("'" + text + "' is no ID=SIZE, as 0=27.1mm");
  const double size = parseLength(text.substr(equals + 1));
  if (!(size > 0 && size < 100)) throw Error("'" + text + "': a size must be above 0");
  return {static_cast<int>(*id), size};
}

int runCalibrate(const CalibrateOptions& options, Console& console) {
  requireWritable(options.output, {options.input}, options.board ? FileKind::yaml : FileKind::json);
  if (options.board && options.still) throw Error("--accelerometers: not with --board");
  if (options.force && (options.board || options.still))
    throw Error("--force: not with --board or --accelerometers");
  const bool text = options.still || options.force || !isOfFrames(options.input);
  if (options.board || text)
    console.warnOfNoEffect({"--camera", "--length", "--refine-camera"},
                           "but with frames of a rig that is waved");
  if (options.force) return reportForce(options, console);
  if (options.board) return reportCamera(options, console);
  if (options.still) return reportAxes(options, console);
  return text ? reportTip(options, console) : reportRig(options, console);
}

} // namespace

Command calibrateCommand() {
  auto options = std::make_shared<CalibrateOptions>();
  return {
      .name = "calibrate",
      .summary = "a camera from views of a board; a probe's rig of markers, tip, accelerometers",
      .description =
          "With --board INPUT is a folder of pictures, a video, camera:0 and so on, or "
          "replay:SCAN, and CAMERA.yml gets what OpenCV calls camera_matrix and "
          "distortion_coefficients, with the deviation of each. Views without the board are named "
          "and left out. Of pictures all are used; of a video at most 60 frames that are sharp and "
          "show the board in different places. A live source says where to hold the board next, "
          "and is read until it was everywhere in the picture and tilted to all sides, or until "
          "Ctrl-C. Both layouts of ChArUco boards are known, that of OpenCV before 4.6 and that "
          "since. Where corners miss by more than 1.5 px nothing is written, and the "
          "exit code is 1.\n"
          "With --accelerometers INPUT is a scan folder (poses.tum, probe.csv) of a probe that was "
          "held "
          "still in the air, tilted to all sides, and RIG.json gets the accelerometers' axes, "
          "gravity and the force's zero; --rig gives approximate axes.\n"
          "With neither, INPUT is a scan folder, a video or a live source in which the rig of "
          "markers is waved before the camera to all sides, turned about its tip in a dimple for "
          "ten seconds, and laid to rest: a minute in all. --rig says where the markers should be, "
          "and RIG.json gets where they are, their sizes and the tip, with deviations. One marker "
          "that was measured by --length gives the scale. The report names markers that are "
          "exchanged, turned or elsewhere, and what the motion does not determine, which stays "
          "as it was.\n"
          "Or INPUT is a file of poses while the probe's tip stood still and the probe "
          "turned about it to all sides, and RIG.json gets the tip and the content of --rig. Poses "
          "that contradict the others are left out.",
      .examples =
          {"patina calibrate camera:0 --board charuco:8x5:32mm:24mm:5x5_50 -o camera.yml",
           "patina calibrate views --board chessboard:9x6:25mm -o camera.yml",
           "patina calibrate views --board charuco:5x7:40mm:20mm:6x6_250 -o camera.yml",
           "patina calibrate board.mp4 --board chessboard:9x6:25mm -o camera.yml",
           "patina calibrate wave --length 0=27.05mm -o rig-as-it-is.json",
           "patina calibrate turning.tum --rig rig.json -o rig-with-tip.json",
           "patina calibrate held --accelerometers --rig rig-with-tip.json -o rig-of-probe.json",
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
              options->camera.board = parseBoard(text);
              options->camera.board_text = text;
              options->board = true;
            }},
           {"--rate", "HZ", "Hz", "",
            "Frames a second of a video that does not say when they were taken.",
            numberInto(1e-3, 1e5, options->camera.rate)},
           {"--accelerometers", "", "", "", "The accelerometers of a probe held still.",
            into(options->still)},
           {"--force", "", "", "",
            "INPUT is a table of known weights and readings (force [N],reading).",
            into(options->force)},
           {"--rig", "RIG.json", "", "",
            "Further content of RIG.json; of frames, where the markers should be, by default "
            "INPUT/rig.json.",
            into(options->rig)},
           {"--camera", "CAMERA.yml", "", "INPUT/camera.yml", "The camera of a waved rig.",
            into(options->camera_file)},
           {"--length", "ID=SIZE", "m", "",
            "Measured side of a marker's black square; may be given for several.",
            [options](const std::string& text) {
              options->waved.fit.measured.push_back(parseMeasuredSize(text));
            }},
           {"--refine-camera", "CAMERA.yml", "", "",
            "Also refine the camera of a waved rig, and write it there.",
            outInto(options->refined)}},
      .run = [options](Console& console) { return runCalibrate(*options, console); }};
}

} // namespace patina::cli
