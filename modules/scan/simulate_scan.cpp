#include "scan/simulate_scan.h"

#include "acquisition/files/camera_file.h"
#include "acquisition/files/scan_tables.h"
#include "acquisition/printing/printed_rig.h"
#include "acquisition/simulation/mesh_strokes.h"
#include "acquisition/simulation/simulated_surface.h"
#include "core/decompose.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json.h"
#include "core/staged_folder.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/pose_file.h"
#include "geometry/mesh/mesh_report.h"

namespace patina {
namespace {

// `mesh` stands as the hand has it: what is scanned looks up.
SimulatedHand handOver(const TriangleMesh& mesh, const SimulateScanOptions& options) try {
  SimulatedHand hand = scanPathsOver(mesh, options.seed, options.seconds, options.speed);
  if (options.roughness > 0)
    hand.relief = [shape = hand.relief, rough = roughSurface(options.seed, options.roughness)](
                      const Vec2& place) { return shape(place) + rough(place); };
  return hand;
} catch (const Error& error) {
  throw Error(options.mesh_name + ": " + error.what() + "; choose another --from");
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

std::string truthText(const SimulateScanOptions& options, const SimulatedProbe& stream,
                      const Pose& camera_from_mesh, const std::string& real_rig) {
  Json bias(Json::Array(stream.bias.begin(), stream.bias.end()));
  Json json = Json::object();
  json.set("mesh_from_camera", poseJson(camera_from_mesh.inverse()))
      .set("roughness", options.roughness);
  json.set("mesh_unit", name(options.unit));
  json.set("compliance", SimulatedHand().compliance).set("bias", bias);
  json.set("clock_offset", stream.clock_offset).set("clock_skew", stream.clock_skew);
  json.set("seed", static_cast<std::int64_t>(options.seed));
  if (options.frames) json.set("rig", parseJson(real_rig, "rig"));
  return json.dump() + "\n";
}

// A simulated scan of poses may replace another one, because it has the same files. Any other scan
// would be mixed with it. The remains of an interrupted run do not count.
void requireNoOther(const std::filesystem::path& folder, bool frames) {
  if (isInterruptedWrite(folder)) return;
  const auto has = [&](const char* name) { return pathExists(folder / name); };
  const bool filmed = has("frames") || has("frames.csv");
  if (filmed || ((has("poses.tum") || has("probe.csv")) && (frames || !has("truth.json"))))
    throw FileError(folder.string(), 0, "holds a scan already: name another folder");
  if (has("path.csv"))
    throw FileError((folder / "path.csv").string(), 0,
                    "is of the scan that is there: take it away, or name another folder");
}

} // namespace

SimulateScanReport simulateScan(const SimulateScanOptions& options, Progress& progress) {
  requireNoOther(options.folder, options.frames);
  const Pose hand_from_mesh(rotationFromTo(options.from, Vec3::UnitZ()));
  const TriangleMesh turned = transformed(options.mesh, Eigen::Affine3d(hand_from_mesh.matrix()));
  const SimulatedHand hand = handOver(turned, options);
  Rig rig;
  const double over = options.frames ? bounds(turned).sizes().z() / 2 - rig.probe.tip.z()
                                     : 0; // there are the markers
  WavedProbe waved;
  waved.tip = rig.probe.tip;
  waved.seconds = options.seconds;
  waved.seed = options.seed;
  const double seconds = options.waved ? waved.seconds : hand.seconds();
  SimulatedCamera filming;
  filming.camera_from_world = cameraOver(bounds(turned), over);
  filming.outliers = options.outliers;
  filming.gaps = dropouts(options.dropouts, seconds);
  SimulatedProbe stream;
  stream.clock_offset = options.clock_offset;
  stream.clock_skew = options.clock_skew;
  const std::vector<RigMarker> cube =
      options.frames ? printedRig({.family = options.family}).markers : std::vector<RigMarker>();
  rig.accelerometers = true;
  rig.gyroscope = options.gyroscope;
  const std::vector<RigMarker> real_cube = madeByHand(cube, options.made, options.seed + 2);
  rig.gravity = filming.camera_from_world.linear() * kGravity;
  progress.report(0.1, "poses");
  std::vector<CameraPose> poses;
  if (!options.frames) poses = simulateCamera(hand, rig.probe, filming, options.seed);
  progress.throwIfCancelled();
  progress.report(0.2, "probe");
  std::vector<ProbeSample> samples;
  if (!options.waved) samples = simulateProbe(hand, rig.probe, stream, options.seed + 1);
  std::vector<RateSample> rates;
  if (!options.waved && options.gyroscope)
    rates = simulateRates(hand, rig.probe, stream, options.seed + 3);
  progress.throwIfCancelled();
  progress.report(0.8, "truth");
  std::vector<double> times;
  const double count = seconds * stream.rate;
  for (double i = 0; i < count; ++i) times.push_back(i / stream.rate);
  std::vector<PathSample> truth;
  if (!options.waved) truth = truthAt(hand, filming.camera_from_world, times);
  for (const double t : options.waved ? times : std::vector<double>()) {
    const Pose pose = wavedPose(waved, t);
    PathSample sample;
    sample.t = t;
    sample.position = pose * waved.tip;
    sample.orientation = Eigen::Quaterniond(pose.linear());
    sample.sigma = sample.sigma_angle = 0;
    truth.push_back(sample);
  }
  progress.throwIfCancelled();

  StagedFolder staged(options.folder, "truth.json");
  const std::filesystem::path& staging = staged.path();
  writeMeshIn(staging / "mesh.obj", options.mesh, options.unit);
  SimulateScanReport report;
  report.files = {"mesh.obj", "rig.json", "truth.csv", "truth.json"};
  if (options.frames) {
    CaptureSettings course;
    course.occlusions = filming.gaps;
    course.look = options.look;
    course.seed = options.seed;
    const ProbeMotion wave = [&waved](double t) { return wavedPose(waved, t); };
    report.frames =
        writeFrames(staging, options.camera.value_or(usualCamera()),
                    options.waved ? wave : motionOf(hand, rig.probe, filming.camera_from_world),
                    seconds, real_cube, course, progress);
    report.files.insert(report.files.end(), {"frames", "frames.csv", "camera.yml"});
  } else {
    writePoses(staging / "poses.tum", poses);
    report.files.emplace_back("poses.tum");
  }
  if (!options.waved) {
    writeProbeStream(staging / "probe.csv", samples, rates);
    report.files.emplace_back("probe.csv");
  }
  writeFileAtomically(staging / "rig.json", rigText(rig, cube));
  writePath(staging / "truth.csv", truth);
  writeFileAtomically(staging / "truth.json",
                      truthText(options, stream, filming.camera_from_world * hand_from_mesh,
                                rigText(rig, real_cube)));
  progress.throwIfCancelled();
  staged.commit();

  report.poses = poses.size();
  report.samples = samples.size();
  report.seconds = seconds;
  for (const PathSample& sample : truth) report.touching += sample.touching;
  report.touching /= static_cast<double>(truth.size());
  return report;
}

} // namespace patina
