// A scan of a mesh whose truth is known, as a scan folder: what `patina simulate-scan` runs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/simulation/simulated_rig.h"
#include "acquisition/simulation/simulated_scan.h"
#include "acquisition/simulation/simulated_streams.h"
#include "geometry/mesh/mesh_unit.h"

namespace patina {

struct SimulateScanOptions {
  std::filesystem::path folder; // is made, or takes a simulated scan of poses' place
  TriangleMesh mesh;            // [m], without defects
  std::string mesh_name;        // name in error messages
  MeshUnit unit = MeshUnit::mm; // unit of mesh.obj
  Vec3 from = Vec3::UnitZ();    // the axis along which the hand sees the mesh
  double seconds = 20;          // at least
  double speed = 0.05;          // approximate speed of the strokes [m/s]
  double roughness = 25e-6;     // rms height of the simulated texture [m]
  std::uint32_t seed = 1;
  int dropouts = 0;        // times of 0.3 s without a pose
  double outliers = 0;     // share of the poses; without `frames`
  double clock_offset = 0; // see SimulatedProbe [s]
  double clock_skew = 0;   // see SimulatedProbe
  bool gyroscope = false;  // the probe's stream has its rates
  bool frames = false; // renders camera frames in place of poses; the options below are for them
  std::optional<Camera> camera; // absent: usualCamera()
  FrameLook look;
  std::string family = "4x4_50"; // marker family
  HandmadeRig made;              // how the real rig differs from rig.json
  // The probe does not touch the mesh: it is waved, turned in a dimple and laid to rest.
  bool waved = false;
};

struct SimulateScanReport {
  std::size_t frames = 0, poses = 0; // one of them is none
  std::size_t samples = 0;           // samples of the probe
  double seconds = 0;
  double touching = 0;            // share of the time
  std::vector<std::string> files; // in the folder
};

// The same options give the same bytes. Throws FileError where the folder holds another scan, Error
// where the hand finds too little to draw over or there is no such family, Cancelled; then the
// folder is as it was.
SimulateScanReport simulateScan(const SimulateScanOptions& options, Progress& progress);

} // namespace patina
