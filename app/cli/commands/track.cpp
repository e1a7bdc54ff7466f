#include <chrono>

#include "acquisition/files/camera_file.h"
#include "app/cli/commands/commands.h"
#include "app/cli/input/input_files.h"
#include "app/cli/input/scan_input.h"
#include "app/cli/output/reports.h"
#include "core/file.h"
#include "core/numbers.h"
#include "core/output_target.h"
#include "core/percentiles.h"
#include "scan/track_scan.h"

namespace patina::cli {

namespace {

struct TrackOptions {
  std::filesystem::path camera, output;
  TrackScanOptions scan;
};

const Keys kTrackKeys = {
    {"lens", "", "lens", "the camera's lens model"},
    {"frames", "", "frames"},
    {"frames_with_pose", "", "with a pose"},
    {"without_pose",
     "",
     "without",
     "a pose, and why",
     Shown::if_any,
     {{"t", "s", ""}, {"why", "", ""}}},
    {"unreadable", "", "unreadable", "frames that are missing or no picture", Shown::if_any},
    {"ambiguous", "", "ambiguous", "frames with an ambiguous tilt of the rig", Shown::if_any},
    {"misfit", "", "misfit", "frames whose markers are not where the rig has them", Shown::if_any},
    {"dropped_markers", "", "dropped", "markers that contradicted the others of a frame",
     Shown::if_any},
    {"repeated", "", "repeated", "frames that show a marker of the rig more than once",
     Shown::if_any},
    {"reprojection_rms_px", "px", "corners miss by", "rms of an image's two axes together"},
    {"sigma",
     "",
     "sigma",
     "of the poses, median",
     Shown::always,
     {{"position", "m", ""}, {"angle", "rad", ""}}},
    {"seconds", "s", "tracked in"}};

Json sigmaJson(const std::vector<CameraPose>& poses) {
  std::vector<double> positions, angles;
  for (const CameraPose& pose : poses) {
    positions.push_back(pose.sigma_position);
    angles.push_back(pose.sigma_angle);
  }
  Json json = Json::object();
  json.set("position", percentiles(positions).p50);
  return json.set("angle", percentiles(angles).p50);
}

int runTrack(TrackOptions options, Console& console) {
  TrackScanOptions& scan = options.scan;
  options.camera = scanFile(options.camera, "--camera", "camera.yml", scan.frames);
  scan.rig = scanFile(scan.rig, "--rig", "rig.json", scan.frames);
  scan.camera = readCamera(options.camera);
  scan.markers = readMarkers(scan.rig);
  requireWritable(options.output, {scan.frames, options.camera, scan.rig}, FileKind::poses);
  if (const auto folder = scanFolderOf(scan.frames); folder && pathExists(*folder / "frames.csv"))
    console.warnOfNoEffect({"--rate"}, "beside frames.csv");
  if (scan.frames.starts_with("camera:")) console.warnOfNoEffect({"--rate"}, "on a camera");
  const auto begin = std::chrono::steady_clock::now();
  const TrackScanReport found = trackScan(scan, console.progress());
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;

  Report report(kTrackKeys);
  report.set("lens", lensName(scan.camera));
  report.set("frames", found.frames).set("frames_with_pose", found.poses.size());
  Json without = Json::array();
  for (const MissingPose& gap : found.without)
    without.push(Json::object().set("t", gap.t).set("why", gap.why));
  report.set("without_pose", without,
             found.without.empty()
                 ? ""
                 : formatCount(found.without.size()) + ", the first at " +
                       rounded(found.without[0].t) + " s: " + found.without[0].why);
  report.set("unreadable", found.unreadable).set("ambiguous", found.ambiguous);
  report.set("misfit", found.misfit).set("dropped_markers", found.dropped);
  report.set("repeated", found.repeated);
  if (!found.poses.empty()) {
    report.set("reprojection_rms_px", found.rms, rounded(found.rms) + " px");
    const Json sigma = sigmaJson(found.poses);
    report.set("sigma", sigma,
               formatLength(sigma.at("position").asNumber()) + ", " +
                   rounded(1e3 * sigma.at("angle").asNumber()) + " mrad");
    writePoses(options.output, found.poses, found.without, found.rig_doubt);
  }
  report.set("seconds", taken.count());
  for (const std::string& line : found.warnings) console.warn(line);
  if (found.poses.empty())
    console.warn(scan.frames + ": no frame shows a pose of the rig, so nothing is written");
  return console.report(report, found.isOfAnotherRig() || found.poses.empty() ? kNotSolved : kDone);
}

} // namespace

Command trackCommand() {
  auto options = std::make_shared<TrackOptions>();
  return {.name = "track",
          .summary = "frames of a camera become poses of the markers' rig, with error bars",
          .description =
              "FRAMES is a scan folder (frames/, frames.csv, camera.yml, rig.json), a folder of "
              "pictures, a video, or live until Ctrl-C: camera:0 and so on, or replay:SCAN, the "
              "frames of a scan folder at their own pace. All markers of the rig that a frame "
              "shows give its pose together, from lines fitted to their edges. A frame without a "
              "pose, by whatever cause, is a comment in POSES.tum and is listed in the report; one "
              "that could be tilted either way is decided by how all faces of the rig look or by "
              "the frame before it, or left out. Exit code 1 if no frame shows a pose, or in most "
              "frames a marker is not where the rig has it and no cause is found; where one is "
              "found, the deviations of the poses contain it.",
          .examples =
              {"patina track scan -o scan/poses.tum",
               "patina track pictures --rate 30 --camera camera.yml --rig rig.json -o poses.tum",
               "patina track hand.mp4 --camera camera.yml --rig rig.json -o poses.tum"},
          .keys = kTrackKeys,
          .arguments =
              {input("FRAMES", "Scan folder, folder of pictures, video, camera:N or replay:SCAN.",
                     Setter([options](const std::string& text) { options->scan.frames = text; },
                            filesOfSource)),
               outputTo(options->output, "POSES.tum", "The poses, with deviations."),
               {"--camera", "CAMERA.yml", "", "FRAMES/camera.yml", "Calibration of the camera.",
                into(options->camera)},
               {"--rig", "RIG.json", "", "FRAMES/rig.json", "Where the markers are on the probe.",
                into(options->scan.rig)},
               {"--rate", "HZ", "Hz", "",
                "Frames a second, where there is no frames.csv, or other than a video says.",
                numberInto(1e-3, 1e5, options->scan.rate)},
               {"--thorough", "", "", "",
                "Look for small, blurred and crowded markers too, ten times as long.",
                into(options->scan.finder.thorough)}},
          .run = [options](Console& console) { return runTrack(*options, console); }};
}

} // namespace patina::cli
