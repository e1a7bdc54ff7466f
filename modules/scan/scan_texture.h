// Extracts a mesh's texture from a registered scan: heights over the mesh, their harmonics, and the
// textured faces. Used by commands, the Texture page and the demo.
#pragma once

#include <string>
#include <vector>

#include "acquisition/filtering/filtered_scan.h"
#include "acquisition/registration/register_path.h"
#include "acquisition/texture/fit_texture.h"
#include "acquisition/texture/map_texture.h"
#include "acquisition/texture/mesh_heights.h"
#include "acquisition/texture/path_strokes.h"
#include "scan/scan_files.h"
#include "scene/scene.h"

namespace patina {

// Options for heights over a mesh: waves longer than 8 mm belong to the mesh's shape.
FitOptions1d scanFitOptions();

// Returns heights along the mesh's mean normal under the path. `scan` was filtered from `poses` for
// contact only and lies on the mesh by `mesh_from_scan`; the filter does not run again.
// `compliance` [m/N] of the surface; absent: estimated from presses over the mesh. The estimate is
// in the result. The target must have sides. Throws Error if there is no height or the rig names no
// accelerometers.
ScanHeights heightsOverMesh(const SurfaceTarget& target, const FilteredScan& scan,
                            const std::vector<CameraPose>& poses, const Rig& rig,
                            const Pose& mesh_from_scan, const std::optional<double>& compliance);

// The same over the plane through where the tip touched, or along `normal` in the camera's frame,
// with what presses say of the compliance.
ScanHeights heightsOverPlane(const FilteredScan& scan, const std::vector<CameraPose>& poses,
                             const Rig& rig, const std::optional<Vec3>& normal);

// Returns the profile of the longest contact interval. `heights` are in order of time.
std::vector<ProfilePoint> profileOf(const std::vector<ScanHeight>& heights);

struct ScannedTexture {
  std::vector<ScanHeight> heights; // over the mesh
  std::vector<PathOnMesh> strokes; // path of the heights, in the mesh's frame
  FittedTexture fitted;            // fit of the longest stretch, with the compliance
  MappedTexture laid;              // set once it is mapped
};
// Where a scan lies on a mesh, as its registration has it.
struct ScanPlace {
  Pose mesh_from_scan = Pose::Identity();
  std::optional<double> compliance; // compliance of the surface [m/N]
  std::vector<TimedPoint> points;   // positions of the inliers in the mesh's frame
};
// `path`: the samples of the scan that took part in `registration`, its own result.
ScanPlace scanPlace(const std::vector<PathSample>& path, const Registration& registration);
// `scan`, `poses` and exceptions are as in heightsOverMesh().
ScannedTexture fitScanTexture(const SurfaceTarget& target, const FilteredScan& scan,
                              const std::vector<CameraPose>& poses, const Rig& rig,
                              const ScanPlace& place,
                              const FitOptions1d& options = scanFitOptions());

// Maps the texture to the faces under the strokes; faces that cannot take it keep their numbers.
// Throws Error if no face can take it or the strokes are farther from the mesh than a twentieth of
// its size, and as mapTexture() does.
MappedTexture layScanTexture(const TriangleMesh& mesh, const std::vector<PathOnMesh>& strokes,
                             const LayOptions& options, const Progress& progress);

// Writes an OBJ of the mesh with the textured faces; `scale` converts metres to its unit. Throws
// FileError.
void writeTexturedMesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                       std::vector<TexturedFace> faces, double scale);

// Makes a scene of one object with these textures, numbered from 1 in order; a later texture wins a
// shared face. Unscanned faces get the mean scanned stiffness, because a step of stiffness at a
// texture's boundary would throw the tip off. Other values are defaults.
Scene texturedScene(TriangleMesh mesh, const std::string& name,
                    const std::vector<ScannedTexture>& textures);

} // namespace patina
