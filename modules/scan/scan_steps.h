// A scan taken to a feel, step by step: what `patina demo` and the window's guided sequence run.
#pragma once

#include <string>
#include <vector>

#include "acquisition/filtering/filtered_scan.h"
#include "acquisition/registration/surface_target.h"
#include "acquisition/texture/fit_texture.h"
#include "acquisition/texture/lay_texture.h"
#include "acquisition/texture/mesh_heights.h"
#include "scene/scene.h"

namespace patina {

// What came of one scan: its poses and the probe's stream, on one clock.
struct ScanStreams {
  std::vector<CameraPose> poses;
  std::vector<ProbeSample> samples;
};

// The tip's path where it touched; gravity in the camera's frame [m/s^2]. Throws Error where it
// never does, Cancelled.
FilteredScan touchedPath(const ScanStreams& streams, const ProbeModel& probe, const Vec3& gravity,
                         Progress& progress);

// Texture that one scan found.
struct ScannedTexture {
  std::vector<ScanHeight> heights; // over the mesh, of the stroke that went farthest
  PathOnMesh stroke;               // where they are, object frame
  FittedTexture fitted;            // with the compliance, where it was found
  LaidTexture laid;                // once it is
};
// The scan is registered. Its heights over the mesh, along the mesh's mean normal under it, become
// harmonics. `scan` was filtered from `poses`, touching only; the filter does not run again.
// Throws as scanHeights() and fitTexture() do.
ScannedTexture fitScan(const SurfaceTarget& target, const FilteredScan& scan,
                       const std::vector<CameraPose>& poses, const ProbeModel& probe,
                       const Vec3& gravity, const Pose& mesh_from_scan, double compliance,
                       const FitOptions1d& options);

// The mesh as a scene of one object with these textures on it, numbered from 1 in their order; of
// faces that several want the later ones get them. What was not scanned is as stiff as what was, on
// the mean, so that no rim of a texture is a step of stiffness that throws the tip off; all else as
// a new scene has it.
Scene texturedScene(TriangleMesh mesh, const std::string& name,
                    const std::vector<ScannedTexture>& textures);

} // namespace patina
