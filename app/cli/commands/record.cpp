#include <cmath>

#include "app/cli/commands/commands.h"
#include "app/cli/input/input_files.h"
#include "app/cli/output/reports.h"
#include "scan/record_scan.h"
#include "scan/track_scan.h"

namespace patina::cli {

namespace {

const Keys kRecordKeys = {
    {"seconds", "s", "recorded"},
    {"frames", "", "frames"},
    {"frames_with_pose", "", "with a pose", "", Shown::if_any},
    {"skipped", "", "skipped", "frames that there was no time to track: patina track finds them",
     Shown::if_any},
    {"unreadable", "", "unreadable", "frames", Shown::if_any},
    {"samples", "", "samples", "of the probe"},
    {"dropouts", "", "dropouts", "where the probe's stream lacks more than 50 ms", Shown::if_any},
    {"packets", "", "packets", "of a probe that numbers them, as what follows", Shown::if_any},
    {"lost_packets", "", "lost packets", "whose numbers never came"},
    {"lost_samples", "", "lost samples", "in them", Shown::if_any},
    {"corrupt", "", "corrupt", "packets, which are among the lost", Shown::if_any},
    {"repeated", "", "repeated", "packets, left out", Shown::if_any},
    {"restarts", "", "restarts", "of the probe", Shown::if_any},
    {"saturated", "", "beyond a sensor's range", "samples", Shown::if_any},
    {"silent", "", "without a sensor's answer", "packets", Shown::if_any},
    {"clock_skew", "", "clock",
     "by how much the probe's runs faster than this machine's, after 10 s", Shown::never}};

void setHealth(const ProbeHealth& health, Report& report) {
  report.set("packets", health.packets).set("lost_packets", health.lost_packets);
  report.set("lost_samples", health.lost_samples).set("corrupt", health.corrupt);
  report.set("repeated", health.repeated).set("restarts", health.restarts);
  report.set("saturated", health.saturated).set("silent", health.silent);
  if (!health.skew) return;
  report.set("clock_skew", *health.skew);
  report.tell("clock", rounded(1e6 * std::abs(*health.skew)) + " ppm " +
                           (*health.skew < 0 ? "slower" : "faster") + " than this machine's");
}

int runRecord(RecordScanOptions options, Console& console) {
  RecordingSetup& setup = options.setup;
  const auto beside = [&](std::filesystem::path& file, const std::string& name) {
    const auto folder = scanFolderOf(options.frames);
    if (file.empty() && folder && std::filesystem::exists(*folder / name)) file = *folder / name;
  };
  beside(setup.camera, "camera.yml");
  beside(setup.rig, "rig.json");
  const RecordScanReport found = recordScan(options, console.progress());
  const RecordingState& state = found.state;
  Report report(kRecordKeys);
  report.set("seconds", state.seconds).set("frames", state.frames);
  if (state.tracks) report.set("frames_with_pose", state.poses);
  report.set("skipped", state.skipped);
  report.set("unreadable", state.unreadable).set("samples", state.samples);
  report.set("dropouts", state.dropouts);
  if (state.probe) setHealth(*state.probe, report);
  for (const std::string& line : found.warnings) console.warn(line);
  return console.report(report, found.complete ? kDone : kNotSolved);
}

} // namespace

Command recordCommand() {
  auto options = std::make_shared<RecordScanOptions>();
  const auto text = [](std::string& target) {
    return Setter([&target](const std::string& word) { target = word; }, filesOfSource);
  };
  return {
      .name = "record",
      .summary = "a camera and a probe become a scan folder while they run",
      .description =
          "FRAMES is camera:0 and so on, replay:SCAN, the frames of a scan folder at their own "
          "pace, a video or a folder of pictures; PROBE is stream:PATH, lines of a probe.csv as "
          "they come from a pipe or a serial device, serial:PATH or usb:SERIAL, the packets of "
          "docs/usb_protocol.md over a serial line or USB (usb: is the first probe), replay:SCAN, "
          "or with a video or folder a probe.csv. PATH@BAUD sets the rate of a serial line. "
          "Packets are numbered: what is lost is counted. "
          "Recording ends with Ctrl-C, after --seconds, or with the frames.\n"
          "Without CAMERA.yml or RIG.json the frames are recorded, and nothing is tracked: so are "
          "the first pictures made, of which patina calibrate finds both.\n"
          "SCAN gets frames/, frames.csv, probe.csv, poses.tum, camera.yml and rig.json, all as it "
          "is made: a program that is killed loses less than a second. Every frame is written; if "
          "tracking is too slow it leaves frames out of poses.tum, counts them, and patina track "
          "SCAN -o SCAN/poses.tum finds them later. Where a source or the disk fails in the middle "
          "the report is printed, and the exit code is 1.",
      .examples = {"patina record camera:0 --probe serial:/dev/ttyACM0 --camera camera.yml --rig "
                   "rig.json -o scan",
                   "patina record replay:scan --probe replay:scan --seconds 5 -o again"},
      .keys = kRecordKeys,
      .arguments =
          {input("FRAMES", "camera:N, replay:SCAN, video, or folder.", text(options->frames)),
           outputTo(options->setup.folder, "SCAN", "The scan folder, which is made."),
           {"--probe", "PROBE", "", "",
            "stream:PATH, serial:PATH, usb:, replay:SCAN, or a probe.csv.", text(options->probe)},
           {"--camera", "CAMERA.yml", "", "FRAMES/camera.yml",
            "What the camera's calibration says; without one nothing is tracked.",
            into(options->setup.camera)},
           {"--rig", "RIG.json", "", "FRAMES/rig.json", "Where the markers are on the probe.",
            into(options->setup.rig)},
           {"--seconds", "S", "s", "", "How long.", numberInto(1e-3, 1e6, options->seconds)},
           {"--rate", "HZ", "Hz", "",
            "Frames a second, where nothing says so, or other than a video says.",
            numberInto(1e-3, 1e5, options->rate)}},
      .run = [options](Console& console) { return runRecord(*options, console); }};
}

} // namespace patina::cli
