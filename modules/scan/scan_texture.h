// What a registered scan says of a mesh's texture: heights over the mesh, harmonics of them, and
// the faces on which they are felt. Commands, the desk Texture and the demo run these.
#pragma once

#include <string>
#include <vector>

#include "acquisition/filtering/filtered_scan.h"
#include "acquisition/registration/register_path.h"
#include "acquisition/texture/fit_texture.h"
#include "acquisition/texture/lay_texture.h"
#include "acquisition/texture/mesh_heights.h"
#include "scan/scan_files.h"
#include "scene/scene.h"

namespace patina {

// Of heights over a mesh: longer waves than 8 mm are the body's shape, which the mesh has.
FitOptions1d scanFitOptions();

// Heights along the mesh's mean normal under the path. `scan` was filtered from `poses`, touching
// only, and lies on the mesh as `mesh_from_scan` says; the filter does not run again. The surface
// yields by `compliance` [m/N], where that is absent by what presses over the mesh say; what they
// say is in the result. The target has sides. Throws Error where there is no height, or the rig
// names no accelerometers.
ScanHeights heightsOverMesh(const SurfaceTarget& target, const FilteredScan& scan,
                            const std::vector<CameraPose>& poses, const Rig& rig,
                            const Pose& mesh_from_scan, const std::optional<double>& compliance);

// Of the stretch of contact that goes farthest. Heights in the order of time.
std::vector<ProfilePoint> profileOf(const std::vector<ScanHeight>& heights);

// Texture that one scan found.
struct ScannedTexture {
  std::vector<ScanHeight> heights; // over the mesh
  std::vector<PathOnMesh> strokes; // where they are, in the mesh's frame
  FittedTexture fitted;            // of the longest stretch, with the compliance
  LaidTexture laid;                // once it is
};
// `path` is what of the scan took part in `registration`, which is its own.
ScannedTexture fitScanTexture(const SurfaceTarget& target, const FilteredScan& scan,
                              const std::vector<CameraPose>& poses, const Rig& rig,
                              const std::vector<PathSample>& path, const Registration& registration,
                              const FitOptions1d& options = scanFitOptions());

// The texture on the faces under the strokes; faces on which nothing can lie keep their numbers.
// Throws Error where no face can take it, or the strokes lie farther from the mesh than a twentieth
// of its size, and as layTexture() does.
LaidTexture layScanTexture(const TriangleMesh& mesh, const std::vector<PathOnMesh>& strokes,
                           const LayOptions& options, const Progress& progress);

// An OBJ of the mesh with the textures' faces; `scale` makes metres of its unit. Throws FileError.
void writeTexturedMesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                       std::vector<TexturedFace> faces, double scale);

// The mesh as a scene of one object with these textures on it, numbered from 1 in their order; of
// faces that several want the later ones get them. What was not scanned is as stiff as what was, on
// the mean, so that no rim of a texture is a step of stiffness that throws the tip off; all else as
// a new scene has it.
Scene texturedScene(TriangleMesh mesh, const std::string& name,
                    const std::vector<ScannedTexture>& textures);

} // namespace patina
