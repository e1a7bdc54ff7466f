#include "acquisition/files/camera_file.h"
#include "acquisition/files/scan_files.h"
#include "acquisition/simulation/mesh_strokes.h"
#include "acquisition/simulation/simulated_scan.h"
#include "acquisition/simulation/simulated_streams.h"
#include "acquisition/simulation/simulated_surface.h"
#include "acquisition/tracking/marker_code.h"
#include "app/cli/commands/commands.h"
#include "app/cli/input/mesh_input.h"
#include "app/cli/output/mesh_output.h"
#include "app/cli/output/reports.h"
#include "core/decompose.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "core/staged_folder.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/pose_file.h"
#include "geometry/mesh/mesh_report.h"

namespace patina::cli {

namespace {

struct ScanOptions {
  std::filesystem::path mesh, output;
  MeshUnit unit = MeshUnit::mm;
  Vec3 from = Vec3::UnitZ();
  double seconds = 20, speed = 0.05, roughness = 25e-6;
  std::uint32_t seed = 1;
  int dropouts = 0;
  SimulatedCamera camera;
  SimulatedProbe probe;
  bool frames = false;
  std::filesystem::path lens; // camera.yml
  FrameLook look;
  std::string family = "4x4_50";
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

// `mesh` stands as the hand has it: what is scanned looks up.
SimulatedHand handOver(const TriangleMesh& mesh, const ScanOptions& options) try {
  SimulatedHand hand = strokesOver(mesh, options.seed, options.seconds, options.speed);
  if (options.roughness > 0)
    hand.relief = [shape = hand.relief, rough = roughSurface(options.seed, options.roughness)](
                      const Vec2& place) { return shape(place) + rough(place); };
  return hand;
} catch (const Error& error) {
  throw Error(options.mesh.string() + ": " + error.what() + "; choose another --from");
}

// Short times without a pose, evenly spread.
std::vector<Gap> dropouts(int count, double seconds) {
  std::vector<Gap> gaps;
  for (int i = 0; i < count; ++i) {
    const double from = seconds * (i + 0.7) / count;
    gaps.push_back({from, from + 0.3});
  }
  return gaps;
}

// Of mesh.obj.
MeshUnit writtenUnit(const ScanOptions& options) {
  return options.unit == MeshUnit::fit ? MeshUnit::mm : options.unit;
}

std::string truthText(const ScanOptions& options, const Pose& camera_from_mesh) {
  Json bias(Json::Array(options.probe.bias.begin(), options.probe.bias.end()));
  Json json = Json::object();
  json.set("mesh_from_camera", poseJson(camera_from_mesh.inverse()))
      .set("roughness", options.roughness);
  json.set("mesh_unit", name(writtenUnit(options)));
  json.set("compliance", SimulatedHand().compliance).set("bias", bias);
  json.set("clock_offset", options.probe.clock_offset).set("clock_skew", options.probe.clock_skew);
  json.set("seed", static_cast<std::int64_t>(options.seed));
  return json.dump() + "\n";
}

// A simulated scan of poses may take another one's place, for it has the same files. Whatever else
// is a scan would be mixed with it; what a run that was killed has left is none.
void requireNoOther(const std::filesystem::path& folder, bool frames) {
  if (wasAbandoned(folder)) return;
  const auto has = [&](const char* name) { return pathExists(folder / name); };
  const bool filmed = has("frames") || has("frames.csv");
  if (filmed || ((has("poses.tum") || has("probe.csv")) && (frames || !has("truth.json"))))
    throw FileError(folder.string(), 0, "holds a scan already: name another folder");
  if (has("path.csv"))
    throw FileError((folder / "path.csv").string(), 0,
                    "is of the scan that is there: take it away, or name another folder");
}

int runSimulateScan(ScanOptions options, Console& console) {
  const std::filesystem::path& folder = options.output;
  if (isStandardStream(folder)) throw Error("--output: a scan is a folder, not a stream");
  if (options.frames)
    console.warnOfNoEffect({"--outliers"}, "with --frames");
  else
    console.warnOfNoEffect({"--camera", "--markers", "--blur", "--noise"}, "without --frames");
  requireNoOther(folder, options.frames);
  if (std::filesystem::is_directory(folder)) requireWritable(folder / "mesh.obj", {options.mesh});
  ScaledMesh scaled = readScaledMesh(options.mesh, options.unit, console);
  const TriangleMesh mesh = cleaned(std::move(scaled.mesh)).mesh;
  const Pose hand_from_mesh(turnFromTo(options.from, Vec3::UnitZ()));
  const TriangleMesh turned = transformed(mesh, Eigen::Affine3d(hand_from_mesh.matrix()));
  const SimulatedHand hand = handOver(turned, options);
  Rig rig;
  const double over = options.frames ? bounds(turned).sizes().z() / 2 - rig.probe.tip.z()
                                     : 0; // there are the markers
  const Pose camera_from_hand = cameraOver(bounds(turned), over);
  options.camera.camera_from_world = camera_from_hand;
  options.camera.gaps = dropouts(options.dropouts, hand.seconds());
  Camera camera = usualCamera();
  if (!options.lens.empty()) camera = readCamera(options.lens);
  const MarkerFamily* family = options.frames ? &markerFamily(options.family) : nullptr;
  const std::vector<RigMarker> cube =
      family ? markerCube(options.family, family->side, kCubeEdge) : std::vector<RigMarker>();
  rig.gravity = camera_from_hand.linear() * kGravity;
  console.progress().report(0.1, "poses");
  std::vector<CameraPose> poses;
  if (!options.frames) poses = simulateCamera(hand, rig.probe, options.camera, options.seed);
  console.progress().throwIfCancelled();
  console.progress().report(0.2, "probe");
  const std::vector<ProbeSample> samples =
      simulateProbe(hand, rig.probe, options.probe, options.seed + 1);
  console.progress().throwIfCancelled();
  console.progress().report(0.8, "truth");
  std::vector<double> times;
  for (double i = 0; i < hand.seconds() * options.probe.rate; ++i)
    times.push_back(i / options.probe.rate);
  const std::vector<PathSample> truth = truthAt(hand, camera_from_hand, times);
  console.progress().throwIfCancelled();

  StagedFolder staged(folder, "truth.json");
  const std::filesystem::path& staging = staged.path();
  writeMeshIn(staging / "mesh.obj", mesh, writtenUnit(options));
  std::vector<std::string> files = {"mesh.obj", "probe.csv", "rig.json", "truth.csv", "truth.json"};
  std::size_t frames = 0;
  if (options.frames) {
    FrameCourse course;
    course.camera_from_world = options.camera.camera_from_world;
    course.covered = options.camera.gaps;
    course.look = options.look;
    course.seed = options.seed;
    frames =
        writeFrames(staging, camera, hand, rig.probe, options.family, course, console.progress());
    files.insert(files.end(), {"frames", "frames.csv", "camera.yml"});
  } else {
    writePoses(staging / "poses.tum", poses);
    files.emplace_back("poses.tum");
  }
  writeProbeStream(staging / "probe.csv", samples);
  writeFileAtomically(staging / "rig.json", rigText(rig, cube));
  writePath(staging / "truth.csv", truth);
  writeFileAtomically(staging / "truth.json",
                      truthText(options, camera_from_hand * hand_from_mesh));
  console.progress().throwIfCancelled();
  staged.commit();

  double touching = 0;
  for (const PathSample& sample : truth) touching += sample.touching;
  touching /= static_cast<double>(truth.size());
  Report report(kSimulateScanKeys);
  if (options.frames)
    report.set("frames", frames);
  else
    report.set("poses", poses.size());
  report.set("samples", samples.size());
  report.set("seconds", hand.seconds(),
             rounded(hand.seconds()) + " s, touching for " + rounded(100 * touching) + " % of it");
  report.set("touching", touching);
  report.set("files", jsonOf(files));
  return console.report(report);
}

} // namespace

Command simulateScanCommand() {
  auto options = std::make_shared<ScanOptions>();
  const auto number = [options](double ScanOptions::*member) {
    return [options, member](double value) { (*options).*member = value; };
  };
  return {
      .name = "simulate-scan",
      .summary = "a scan of a mesh with known truth: poses or frames, the probe's stream",
      .description =
          "A hand scans what of the mesh is seen along an axis and no steeper than 45 degrees: "
          "strokes, presses, pauses, ways back and lift-offs. FOLDER becomes a scan folder with "
          "the poses that a camera would find, the probe's stream, its rig and the truth. The "
          "same words give the same scan. It takes the place of one of poses that was simulated "
          "too; a folder with another scan, or with a path.csv, is refused.\n"
          "With --frames the camera's frames of a cube of markers on the probe take the place of "
          "its poses, which patina track then finds: through a lens, blurred, noisy, unevenly lit; "
          "in dropouts something is before the markers.",
      .examples = {"patina simulate-scan dinosaur.ply -o scan --from -y",
                   "patina simulate-scan sphere.ply -o scan --dropouts 4 --outliers 0.03",
                   "patina simulate-scan sphere.ply -o scan --frames --seconds 5"},
      .keys = kSimulateScanKeys,
      .arguments =
          {input("MESH", "Mesh (.obj .ply .stl).", into(options->mesh)),
           outputTo(options->output, "FOLDER", "The scan folder; made if it is missing."),
           {"--from", "AXIS", "", "+z", "From where: +x, -x, +y, -y, +z or -z.",
            parsedInto(options->from, parseAxis)},
           {"--seconds", "T", "s", "20", "How long, at least, up to 3600.",
            inRange(1, 3600, number(&ScanOptions::seconds))},
           {"--speed", "V", "m/s", "0.05", "Of the strokes, about.",
            inRange(1e-3, 0.5, number(&ScanOptions::speed))},
           {"--roughness", "LENGTH", "m", "0.025mm", "Texture laid onto the mesh, rms.",
            inRange(0, 1e-3, number(&ScanOptions::roughness), NumberKind::length)},
           {"--dropouts", "N", "", "0", "Times of 0.3 s without a pose.",
            inRange(
                0, 1000, [options](double n) { options->dropouts = static_cast<int>(n); },
                NumberKind::whole)},
           {"--outliers", "PART", "", "0", "Of the poses, wrong by centimetres; up to 0.5.",
            inRange(0, 0.5, [options](double part) { options->camera.outliers = part; })},
           {"--frames", "", "", "", "Frames of a camera in place of its poses.",
            into(options->frames)},
           {"--camera", "CAMERA.yml", "", "640 x 480", "That takes them.", into(options->lens)},
           {"--markers", "FAMILY", "", "4x4_50", "Of the markers: apriltag_36h11, 6x6_250 ...",
            [options](const std::string& word) { options->family = word; }},
           {"--blur", "PX", "px", "0.6", "Of lens and focus, a Gaussian's deviation.",
            inRange(0, 20, [options](double px) { options->look.blur = px; })},
           {"--noise", "LEVELS", "", "2", "Of a pixel, of 256 levels.",
            inRange(0, 100, [options](double levels) { options->look.noise = levels; })},
           {"--clock-offset", "T", "s", "0", "By how much the probe's clock is ahead.",
            inRange(-0.5, 0.5, [options](double t) { options->probe.clock_offset = t; })},
           {"--clock-skew", "PART", "", "0", "By how much it runs faster.",
            inRange(-0.01, 0.01, [options](double part) { options->probe.clock_skew = part; })},
           {"--seed", "N", "", "1", "Another hand, another noise.",
            inRange(
                0, 1e9, [options](double n) { options->seed = static_cast<std::uint32_t>(n); },
                NumberKind::whole)},
           {"--unit", "mm|cm|m|in|fit", "", "mm", "Unit of the mesh's numbers.",
            parsedInto(options->unit, parseMeshUnit)}},
      .run = [options](Console& console) { return runSimulateScan(*options, console); }};
}

} // namespace patina::cli
