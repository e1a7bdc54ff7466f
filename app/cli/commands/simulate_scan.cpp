#include "scan/simulate_scan.h"

#include <numbers>

#include "acquisition/files/camera_file.h"
#include "app/cli/commands/commands.h"
#include "app/cli/input/mesh_input.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "geometry/mesh/mesh_report.h"

namespace patina::cli {

namespace {

struct SimulationOptions {
  std::filesystem::path mesh;
  MeshUnit unit = MeshUnit::mm;
  std::filesystem::path lens; // camera.yml
  double glue_angle_deg = 0;
  SimulateScanOptions scan;
};

const Keys kSimulateScanKeys = {{"poses", "", "poses"},
                                {"frames", "", "frames", "in place of poses"},
                                {"samples", "", "samples", "of the probe"},
                                {"seconds", "s", "lasts"},
                                {"touching", "", "touching", "the part of its time", Shown::never},
                                {"files", "", "files", "in the folder"}};

Vec3 parseAxis(const std::string& word) {
  if (word.size() == 2 && (word[0] == '+' || word[0] == '-') && word[1] >= 'x' && word[1] <= 'z')
    return (word[0] == '-' ? -1 : 1) * Vec3::Unit(word[1] - 'x');
  throw Error("'" + word + "' is none of +x, -x, +y, -y, +z, -z");
}

int runSimulateScan(SimulationOptions options, Console& console) {
  SimulateScanOptions& scan = options.scan;
  if (isStandardStream(scan.folder)) throw Error("--output: a scan is a folder, not a stream");
  scan.frames = scan.frames || scan.waved;
  scan.made.glue_angle = options.glue_angle_deg * std::numbers::pi / 180;
  if (scan.waved)
    console.warnOfNoEffect({"--speed", "--clock-offset", "--clock-skew", "--gyroscope"},
                           "with --waved");
  if (scan.frames)
    console.warnOfNoEffect({"--outliers"}, "with --frames");
  else
    console.warnOfNoEffect(
        {"--camera", "--markers", "--blur", "--noise", "--glue", "--glue-angle", "--print-scale"},
        "without --frames");
  if (std::filesystem::is_directory(scan.folder))
    requireWritable(scan.folder / "mesh.obj", {options.mesh});
  scan.mesh = cleaned(readScaledMesh(options.mesh, options.unit, console).mesh).mesh;
  scan.mesh_name = options.mesh.string();
  scan.unit = options.unit == MeshUnit::fit ? MeshUnit::mm : options.unit;
  if (!options.lens.empty()) scan.camera = readCamera(options.lens);
  const SimulateScanReport found = simulateScan(scan, console.progress());
  Report report(kSimulateScanKeys);
  if (scan.frames)
    report.set("frames", found.frames);
  else
    report.set("poses", found.poses);
  report.set("samples", found.samples);
  report.set("seconds", found.seconds,
             rounded(found.seconds) + " s, touching for " + rounded(100 * found.touching) +
                 " % of it");
  report.set("touching", found.touching);
  report.set("files", jsonOf(found.files));
  return console.report(report);
}

} // namespace

Command simulateScanCommand() {
  auto options = std::make_shared<SimulationOptions>();
  SimulateScanOptions& scan = options->scan;
  return {
      .name = "simulate-scan",
      .summary = "a scan of a mesh with known truth: poses or frames, the probe's stream",
      .description =
          "A hand scans the part of the mesh that is visible along an axis and not steeper than 45 "
          "degrees: strokes, presses, pauses, returns and lift-offs. FOLDER becomes a scan folder "
          "with the poses that a camera would find, the probe's stream, its rig and the truth. The "
          "same options give the same scan. It replaces an earlier simulated scan of poses; a "
          "folder with another scan, or with a path.csv, is rejected.\n"
          "With --frames the camera's frames of a cube of markers on the probe replace its poses, "
          "which patina track then finds. The frames have lens distortion, blur, noise and uneven "
          "light; in dropouts the markers are hidden. --glue, --glue-angle and --print-scale make "
          "the "
          "real rig differ from rig.json, as one made by hand does; truth.json has the real one. "
          "With --waved the probe touches nothing: it is waved before the camera, turned about "
          "its tip in a dimple and laid to rest, for patina calibrate --rig.",
      .examples = {"patina simulate-scan dinosaur.ply -o scan --from -y",
                   "patina simulate-scan sphere.ply -o scan --dropouts 4 --outliers 0.03",
                   "patina simulate-scan sphere.ply -o scan --frames --seconds 5",
                   "patina simulate-scan sphere.ply -o wave --waved --seconds 60 --glue 0.3mm "
                   "--glue-angle 0.5"},
      .keys = kSimulateScanKeys,
      .arguments =
          {input("MESH", "Mesh (.obj .ply .stl).", into(options->mesh)),
           outputTo(scan.folder, "FOLDER", "The scan folder; made if it is missing."),
           {"--from", "AXIS", "", "+z", "From where: +x, -x, +y, -y, +z or -z.",
            parsedInto(scan.from, parseAxis)},
           {"--seconds", "T", "s", "20", "How long, at least, up to 3600.",
            numberInto(1, 3600, scan.seconds)},
           {"--speed", "V", "m/s", "0.05", "Of the strokes, about.",
            numberInto(1e-3, 0.5, scan.speed)},
           {"--roughness", "LENGTH", "m", "0.025mm", "Texture laid onto the mesh, rms.",
            numberInto(0, 1e-3, scan.roughness, NumberKind::length)},
           {"--dropouts", "N", "", "0", "Times of 0.3 s without a pose.",
            numberInto(0, 1000, scan.dropouts, NumberKind::whole)},
           {"--outliers", "PART", "", "0", "Of the poses, wrong by centimetres; up to 0.5.",
            numberInto(0, 0.5, scan.outliers)},
           {"--frames", "", "", "", "Frames of a camera in place of its poses.", into(scan.frames)},
           {"--camera", "CAMERA.yml", "", "640 x 480", "That takes them.", into(options->lens)},
           {"--markers", "FAMILY", "", "4x4_50", "Of the markers: apriltag_36h11, 6x6_250 ...",
            [&scan](const std::string& word) { scan.family = word; }},
           {"--blur", "PX", "px", "0.6", "Of lens and focus, a Gaussian's deviation.",
            numberInto(0, 20, scan.look.blur)},
           {"--noise", "LEVELS", "", "2", "Of a pixel, of 256 levels.",
            numberInto(0, 100, scan.look.noise)},
           {"--glue", "LENGTH", "m", "0", "By which the markers are off on the rig, each axis.",
            numberInto(0, 0.02, scan.made.glue, NumberKind::length)},
           {"--glue-angle", "DEG", "deg", "0", "By which they are turned, each axis.",
            numberInto(0, 20, options->glue_angle_deg)},
           {"--print-scale", "PART", "", "1", "Size of the printed markers over that of rig.json.",
            numberInto(0.5, 2, scan.made.print_scale)},
           {"--waved", "", "", "", "Frames of a probe that is waved for its calibration.",
            into(scan.waved)},
           {"--clock-offset", "T", "s", "0", "By how much the probe's clock is ahead.",
            numberInto(-0.5, 0.5, scan.clock_offset)},
           {"--clock-skew", "PART", "", "0", "By how much it runs faster.",
            numberInto(-0.01, 0.01, scan.clock_skew)},
           {"--gyroscope", "", "", "", "The probe's stream has the rates of a gyroscope, too.",
            into(scan.gyroscope)},
           {"--seed", "N", "", "1", "Another hand, another noise.",
            numberInto(0, 1e9, scan.seed, NumberKind::whole)},
           unitOfMesh(options->unit)},
      .run = [options](Console& console) { return runSimulateScan(*options, console); }};
}

} // namespace patina::cli
