// The whole of both papers on one toy: scanned, tracked, filtered, registered, fitted, mapped,
// painted and felt, each step judged by the truth that the simulation knows.
#pragma once

#include <filesystem>

#include "acquisition/calibration/board.h"
#include "acquisition/files/scan_files.h"
#include "acquisition/simulation/path_error.h"
#include "demo/demo_object.h"
#include "demo/felt_error.h"
#include "demo/spectrum_error.h"
#include "scan/filter_scan.h"
#include "scan/register_scans.h"
#include "scan/scan_texture.h"
#include "session/build/compile_scene.h"

namespace patina {

// One hand's scan: of a material, or the survey.
struct DemoScan {
  std::string name;
  SimulatedHand hand;
  ScanStreams streams;
  std::size_t frames = 0;
  double tip_error = 0; // of the poses, rms [m]
  FilteredScan filtered;
  PathError path_error;
};

// What became of one material.
struct DemoTexture {
  ScannedTexture scanned;
  SpectrumError spectrum;
  double stiffness = 0; // that was felt: of the force over the depth where it was pressed [N/m]
  std::vector<FeltPoint> felt;
  FeltError felt_error;
};

struct Demo {
  Demo(std::filesystem::path folder, std::uint32_t seed, DemoObject object = demoObject());

  std::filesystem::path folder;
  std::uint32_t seed;
  DemoObject object;
  TriangleMesh in_file; // the object's, in its file's millimetres
  SurfaceTarget target;
  Pose camera_from_object = Pose::Identity(); // the truth
  Rig rig;
  std::vector<DemoScan> scans; // the materials' in their order, then the survey
  RegisteredScans registered;
  double registration_error = 0;                 // of the paths' samples, rms [m]
  std::vector<DemoTexture> textures;             // by material
  std::shared_ptr<const CompiledScene> compiled; // as the workspace was left
  std::vector<double> seconds;                   // of each step that ran
};

// To be run in this order, each once; each leaves its files in the demo's folder. Where one throws
// the demo is half made: it begins anew.
struct DemoStep {
  std::string name;  // "track"
  std::string about; // one line, for a person
  void (*run)(Demo&, Progress&);
};
const std::vector<DemoStep>& demoSteps();

// Runs the next step and notes its seconds. Throws what it throws, Cancelled too.
void runNext(Demo& demo, Progress& progress);
bool isDone(const Demo& demo);

} // namespace patina
