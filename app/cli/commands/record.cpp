#include <chrono>
#include <cmath>
#include <thread>

#include "acquisition/recording/recorder.h"
#include "app/cli/commands/commands.h"
#include "app/cli/input/input_files.h"
#include "app/cli/input/scan_input.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina::cli {

namespace {

struct RecordOptions {
  std::string frames, probe;
  RecordingSetup setup;
  double rate = 0;
  std::optional<double> seconds;
};

const Keys kRecordKeys = {
    {"seconds", "s", "recorded"},
    {"frames", "", "frames"},
    {"frames_with_pose", "", "with a pose"},
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

int runRecord(RecordOptions options, Console& console) {
  RecordingSetup& setup = options.setup;
  setup.camera = besideFrames(setup.camera, "--camera", "camera.yml", options.frames);
  setup.rig = besideFrames(setup.rig, "--rig", "rig.json", options.frames);
  auto frames = openFrames(options.frames, options.rate);
  auto probe = options.probe.empty() ? nullptr : openProbe(options.probe);
  Recorder recorder(std::move(frames), std::move(probe), setup);
  RecordingState now;
  for (now = recorder.poll().state; now.running; now = recorder.poll().state) {
    const bool over = options.seconds && now.seconds >= *options.seconds;
    if (over || console.progress().cancelled()) recorder.stop();
    console.progress().report(options.seconds ? std::min(1., now.seconds / *options.seconds) : 0,
                              formatCount(now.frames) + " frames, " + formatCount(now.poses) +
                                  " poses, " + formatCount(now.samples) + " samples");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const bool empty = now.frames == 0 && now.samples == 0;
  if (!now.error.empty() && empty) throw Error(now.error);
  Report report(kRecordKeys);
  report.set("seconds", now.seconds).set("frames", now.frames);
  report.set("frames_with_pose", now.poses).set("skipped", now.skipped);
  report.set("unreadable", now.unreadable).set("samples", now.samples);
  report.set("dropouts", now.dropouts);
  if (now.probe) setHealth(*now.probe, report);
  console.warn(now.left_out);
  for (const std::string& line : now.notes) console.warn(line);
  if (now.frames == 0)
    console.warn(setup.folder.string() + ": no frame came, so the scan is empty");
  if (!now.error.empty()) console.warn(now.error + "; what had reached the disk by then is kept");
  const bool silent = !options.probe.empty() && now.samples == 0;
  if (silent) console.warn(options.probe + ": the probe sent nothing");
  return console.report(report,
                        now.frames > 0 && !silent && now.error.empty() ? kDone : kNotSolved);
}

} // namespace

Command recordCommand() {
  auto options = std::make_shared<RecordOptions>();
  const auto text = [](std::string& target) {
    return Setter([&target](const std::string& word) { target = word; }, filesOfSource);
  };
  return {
      .name = "record",
      .summary = "a camera and a probe become a scan folder while they run",
      .description =
          "FRAMES is camera:0 and so on, replay:SCAN, the frames of a scan folder at their own "
          "pace, "
          "a video or a folder of pictures; PROBE is stream:PATH, lines of a probe.csv as they "
          "come "
          "from a pipe or a serial device, serial:PATH or usb:SERIAL, the packets of "
          "docs/usb_protocol.md over a serial line or USB (usb: is the first probe), replay:SCAN, "
          "or "
          "with a video or folder a probe.csv. Packets are numbered: what is lost is counted. "
          "Recording ends with Ctrl-C, after --seconds, or with the frames.\n"
          "SCAN gets frames/, frames.csv, probe.csv, poses.tum, camera.yml and rig.json, all as it "
          "is "
          "made: a program that is killed loses less than a second. Every frame is written; "
          "where tracking cannot keep up it leaves frames out of poses.tum, counts them, and "
          "patina track SCAN -o SCAN/poses.tum finds them later. Where a source or the disk fails "
          "in the middle the report is printed, and the exit code is 1.",
      .examples = {"patina record camera:0 --probe serial:/dev/ttyACM0 --camera camera.yml --rig "
                   "rig.json -o scan",
                   "patina record replay:scan --probe replay:scan --seconds 5 -o again"},
      .keys = kRecordKeys,
      .arguments = {input("FRAMES", "camera:N, replay:SCAN, video, or folder.",
                          text(options->frames)),
                    outputTo(options->setup.folder, "SCAN", "The scan folder, which is made."),
                    {"--probe", "PROBE", "", "",
                     "stream:PATH, serial:PATH, usb:, replay:SCAN, or a probe.csv.",
                     text(options->probe)},
                    {"--camera", "CAMERA.yml", "", "FRAMES/camera.yml",
                     "What the camera's calibration says.", into(options->setup.camera)},
                    {"--rig", "RIG.json", "", "FRAMES/rig.json",
                     "Where the markers are on the probe.", into(options->setup.rig)},
                    {"--seconds", "S", "s", "", "How long.",
                     inRange(1e-3, 1e6, [options](double s) { options->seconds = s; })},
                    {"--rate", "HZ", "Hz", "",
                     "Frames a second, where nothing says so, or other than a video says.",
                     inRange(1e-3, 1e5, [options](double rate) { options->rate = rate; })}},
      .run = [options](Console& console) { return runRecord(*options, console); }};
}

} // namespace patina::cli
