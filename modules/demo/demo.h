// Demonstration of both papers on one toy: scan, track, filter, register, fit, map, paint and
// render, with every step compared with the simulation's ground truth.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "acquisition/calibration/board.h"
#include "acquisition/files/scan_tables.h"
#include "acquisition/simulation/path_error.h"
#include "acquisition/simulation/simulated_hand.h"
#include "demo/truth_errors.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scan/filter_scan.h"
#include "scan/register_scans.h"
#include "scan/scan_texture.h"
#include "session/compile/compile_scene.h"

namespace patina {

// The scanned object of the demonstration: a toy with three materials of known height.

// Heights are above the plane that faces the camera: x along the toy, y up.
struct DemoMaterial {
  std::string name;
  std::function<double(const Vec2&)> height;   // above the mesh, along the view [m]
  double stiffness = 0;                        // [N/m]
  Vec2 from = Vec2::Zero(), to = Vec2::Zero(); // stroke of its scan [m]
  double wavelength = 0, amplitude = 0;        // strongest wave along the stroke [m]
  Vec3 color = Vec3::Ones();                   // sRGB, colour of its paint
};

struct DemoObject {
  std::string name;
  TriangleMesh mesh;                         // object frame [m]
  Pose plane_from_object = Pose::Identity(); // the scanned side is up
  std::vector<DemoMaterial> materials;
  // The true toy without materials, over the plane: smooth between the corners of its mesh. Both
  // throw Error outside it.
  std::function<double(const Vec2&)> ground; // height [m]
  std::function<Vec3(const Vec2&)> normal;   // outwards, unit
  std::function<Vec3(double)> grip;          // path over a place without material, for 0 to 1 [m]
  std::vector<Vec2> survey;                  // path of the survey over the bare mesh [m]
};

// Strokes of the materials and the path of the survey, over the plane [m].
struct DemoStroke {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
};
struct DemoStrokes {
  DemoStroke ribs, weave, grain, grip;
  std::vector<Vec2> survey;
};

DemoObject demoObject(); // the dinosaur, twice as large
// Puts the three materials on any body [m]. Throws Error if a stroke leaves it, invalid_argument
// without a survey.
DemoObject demoObjectOf(const std::string& name, TriangleMesh mesh, const Pose& plane_from_object,
                        const DemoStrokes& ways);

// A hand that presses eight times where the material's stroke begins, then strokes it once.
SimulatedHand handOver(const DemoObject& object, const DemoMaterial& material, std::uint32_t seed);
// A hand that goes from limb to limb over the bare mesh, so that the registration has contacts on
// all sides.
SimulatedHand surveyOf(const DemoObject& object, std::uint32_t seed);

// Scan of one material, or the survey.
struct DemoScan {
  std::string name;
  SimulatedHand hand;
  ScanStreams streams;
  std::size_t frames = 0;
  double tip_error = 0; // rms of the poses [m]
  FilteredScan filtered;
  PathError path_error;
};

// Results of one material.
struct DemoTexture {
  ScannedTexture scanned;
  SpectrumError spectrum;
  double stiffness = 0; // rendered: force over depth while pressed [N/m]
  std::vector<ForcePoint> felt;
  ForceError force_error;
};

struct Demo {
  Demo(std::filesystem::path folder, std::uint32_t seed, DemoObject object = demoObject());

  std::filesystem::path folder;
  std::uint32_t seed;
  DemoObject object;
  TriangleMesh in_file; // in its file's millimetres
  SurfaceTarget target;
  Pose camera_from_object = Pose::Identity(); // the truth
  Rig rig;
  std::vector<DemoScan> scans; // the materials' in order, then the survey
  RegisteredScans registered;
  double registration_error = 0;                 // rms of the paths' samples [m]
  std::vector<DemoTexture> textures;             // one per material
  std::shared_ptr<const CompiledScene> compiled; // from the saved workspace
  std::vector<double> seconds;                   // time of each finished step
};

// Run in order, once each; each writes its files into the demo's folder. After a throw, start again
// with a new demo.
struct DemoStep {
  std::string name;  // "track"
  std::string about; // one line for the user
  void (*run)(Demo&, Progress&);
};
const std::vector<DemoStep>& demoSteps();

// Runs the next step and records its seconds. Throws as the step does, Cancelled too.
void runNext(Demo& demo, Progress& progress);
bool isDone(const Demo& demo);

} // namespace patina
