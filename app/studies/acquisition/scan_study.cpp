// The whole way of a scan, with a rig made by hand: frames, calibration, poses, path, registration,
// texture, and the force that a finger feels.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <unistd.h>

#include "acquisition/files/camera_file.h"
#include "acquisition/simulation/path_error.h"
#include "acquisition/simulation/simulated_surface.h"
#include "app/studies/framework/studies.h"
#include "core/error.h"
#include "core/file.h"
#include "field/surface/models.h"
#include "geometry/io/pose_file.h"
#include "scan/calibrate.h"
#include "scan/filter_scan.h"
#include "scan/register_scans.h"
#include "scan/scan_files.h"
#include "scan/scan_texture.h"
#include "scan/simulate_scan.h"
#include "scan/track_scan.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr double kPress = 0.3e-3;    // depth at which the force is compared [m]
constexpr double kRoughness = 25e-6; // rms relief of the body [m]
constexpr double kPrint = 1.01;      // printed size of the markers over that of rig.json

// A folder that ends with this value.
class ScanStudyFolder {
 public:
  ScanStudyFolder()
      : path_(fs::temp_directory_path() / ("patina-study-" + std::to_string(::getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~ScanStudyFolder() {
    std::error_code none;
    fs::remove_all(path_, none);
  }
  ScanStudyFolder(const ScanStudyFolder&) = delete;
  ScanStudyFolder& operator=(const ScanStudyFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

double processSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

struct ScanTrial {
  double path = 0, pose = 0, texture = 0; // rms errors [m]
  double stiffness = 0, felt = 0;         // relative
  double seconds = 0;                     // processor time from frames to texture
};

// Pose, stiffness and heights against the simulation's truth, which the scan does not read.
void judge(const ScanFiles& files, const SurfaceTarget& target, const RegisteredScans& registered,
           const ScannedTexture& texture, std::uint32_t seed, ScanTrial& trial) {
  const fs::path truth_file = files.folder / "truth.json";
  const Pose truth = readPoseAt(truth_file, "mesh_from_camera");
  const double compliance =
      parseJson(readFile(truth_file), truth_file.string()).at("compliance").asNumber();
  const Registration placed = registered.of(0);
  double squares = 0;
  for (const PathSample& sample : registered.paths[0])
    squares += (placed.mesh_from_path * sample.position - truth * sample.position).squaredNorm();
  trial.pose = std::sqrt(squares / static_cast<double>(registered.paths[0].size()));
  const double scanned = texture.fitted.texture.compliance.value_or(0);
  trial.stiffness = scanned > 0 ? std::abs(compliance / scanned - 1) : 1;
  // The same fit to the true relief at the same places, so that both lack the same waves.
  const std::vector<PathSample> tips = readPath(files.folder / "truth.csv");
  const auto relief = roughSurface(seed, kRoughness);
  std::vector<ScanHeight> heights = texture.heights;
  for (ScanHeight& height : heights) {
    const auto at = std::lower_bound(tips.begin(), tips.end() - 1, height.t,
                                     [](const PathSample& tip, double t) { return tip.t < t; });
    // The surface yields along its normal, at whose foot the relief is.
    const SurfaceResidual residual = target.residual(truth * at->position);
    height.point.height = relief(residual.at.head<2>()) * residual.direction.z();
  }
  const FourierTexture real = fitTexture(profileOf(heights), scanFitOptions()).texture;
  constexpr int kPlaces = 2000;
  double error = 0, felt = 0, force = 0;
  for (int i = kPlaces / 20; i < kPlaces - kPlaces / 20; ++i) { // the ends are blended
    const double along = texture.fitted.length * i / kPlaces;
    const double mine = height(texture.fitted.texture, along), others = height(real, along);
    error += (mine - others) * (mine - others);
    const double true_force = (kPress + others) / compliance;
    if (scanned > 0) felt += std::pow((kPress + mine) / scanned - true_force, 2);
    force += true_force * true_force;
  }
  trial.texture = std::sqrt(error / (0.9 * kPlaces));
  trial.felt = scanned > 0 ? std::sqrt(felt / force) : 1;
}

SimulateScanOptions scanOptions(const TriangleMesh& mesh, const fs::path& folder, double seconds,
                                std::uint32_t seed) {
  SimulateScanOptions options;
  options.folder = folder;
  options.mesh = mesh;
  options.mesh_name = "dinosaur";
  options.unit = MeshUnit::m;
  options.roughness = kRoughness;
  options.frames = true;
  options.made = {0.3e-3, 0.5 * std::numbers::pi / 180, kPrint};
  options.seconds = seconds;
  options.seed = seed; // also of the rig
  return options;
}

// Returns the text of rig.json after a calibration by the waved probe. Throws Error without one.
std::string calibratedRig(const TriangleMesh& mesh, const fs::path& folder, double seconds,
                          std::uint32_t seed, Progress& progress) {
  SimulateScanOptions options = scanOptions(mesh, folder, seconds, seed);
  options.waved = true;
  simulateScan(options, progress);
  const fs::path rig = folder / "rig.json";
  RigCalibrationOptions calibration;
  calibration.frames = folder.string();
  calibration.camera = readCamera(folder / "camera.yml");
  const RigMarker measured = readMarkers(rig)[0]; // callipers measure one
  calibration.fit.measured = {{measured.id, kPrint * measured.size}};
  const RigCalibration found = calibrateRig(calibration, {readFile(rig), rig.string()}, progress);
  if (found.file.empty()) throw Error(found.doubt);
  return found.file;
}

// Processes a scan by the rig in its folder. Throws Error if it gives no texture.
ScanTrial processed(const SurfaceTarget& target, const fs::path& folder, std::uint32_t seed,
                    Progress& progress) {
  ScanTrial trial;
  const double begin = processSeconds();
  ScanFiles files = readScanFolder(folder, progress);
  files.poses =
      trackScan({folder.string(), *files.camera, files.markers, folder / "rig.json"}, progress)
          .poses;
  const FilteredScan filtered =
      contactPath({files.poses, files.probe, files.rates}, files.rig, progress);
  const RegisteredScans registered = registerScans(target, {filtered.path}, {}, progress);
  const ScannedTexture texture = fitScanTexture(target, filtered, files.poses, *files.rig,
                                                scanPlace(registered.paths[0], registered.of(0)));
  trial.seconds = processSeconds() - begin;
  trial.path = errorOf(filtered.path, readPath(folder / "truth.csv")).rms;
  judge(files, target, registered, texture, seed, trial);
  return trial;
}

WorkPrecisionRow rowOf(const std::vector<ScanTrial>& trials, std::size_t seeds) {
  WorkPrecisionRow row;
  std::vector<double> felt;
  ScanTrial mean;
  const auto done = static_cast<double>(std::max<std::size_t>(trials.size(), 1));
  for (const ScanTrial& trial : trials) {
    felt.push_back(100 * trial.felt);
    mean.path += trial.path / done;
    mean.pose += trial.pose / done;
    mean.texture += trial.texture / done;
    mean.stiffness += trial.stiffness / done;
    mean.seconds += trial.seconds / done;
  }
  std::sort(felt.begin(), felt.end());
  if (!felt.empty()) {
    row.error = felt[felt.size() / 2];
    row.error_max = felt.back();
  }
  row.ns = 1e9 * mean.seconds;
  row.more = {{"path [mm]", 1e3 * mean.path},
              {"pose [mm]", 1e3 * mean.pose},
              {"stiffness [%]", 100 * mean.stiffness},
              {"texture [um]", 1e6 * mean.texture},
              {"done [%]", 100. * static_cast<double>(trials.size()) / static_cast<double>(seeds)}};
  return row;
}

WorkPrecisionTable scans(const StudyOptions& options, Progress& progress) {
  const std::uint32_t seeds = options.quick ? 1 : options.thorough ? 10 : 3;
  const std::vector<double> lengths =
      options.quick ? std::vector<double>{6} : std::vector<double>{6, 12, 24};
  const TriangleMesh mesh = dinosaur();
  const SurfaceTarget target(mesh, 0, true);
  std::vector<std::vector<ScanTrial>> printed(lengths.size()), calibrated(lengths.size());
  const ScanStudyFolder folder;
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    const std::string name = std::to_string(seed);
    const std::string rig = calibratedRig(mesh, folder.path() / ("wave" + name),
                                          options.quick ? 12 : 60, seed, progress);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      progress.throwIfCancelled();
      const fs::path scan = folder.path() / (name + "-" + std::to_string(i));
      simulateScan(scanOptions(mesh, scan, lengths[i], seed), progress);
      for (auto* trials : {&printed[i], &calibrated[i]}) {
        if (trials == &calibrated[i]) writeFileAtomically(scan / "rig.json", rig);
        try {
          trials->push_back(processed(target, scan, seed, progress));
        } catch (const Error&) { // counted by "done"
          progress.throwIfCancelled();
        }
      }
    }
  }
  WorkPrecisionTable table = tableOf(
      "A scan by a rig made by hand (0.3 mm, 0.5 deg, print 1.01), as printed and calibrated "
      "from " +
          std::string(options.quick ? "12" : "60") +
          " s: force at a depth of 0.3 mm, median and max of the scans; means of the steps' errors",
      "%");
  for (const bool is_calibrated : {false, true})
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      table.rows.push_back(rowOf((is_calibrated ? calibrated : printed)[i], seeds));
      table.rows.back().settings = {{"rig", is_calibrated ? "calibrated" : "as printed"},
                                    {"scan [s]", lengths[i]}};
    }
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> scanStudy(const StudyOptions& options, Progress& progress) {
  return tablesOf({{0, "scans", [&] { return scans(options, progress); }}}, progress);
}

} // namespace patina
