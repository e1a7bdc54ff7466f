// Where a path lies on a mesh, as files of a scan of the scene. No Qt.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/gui/aligning/alignment.h"
#include "scene/scene.h"

namespace patina {

struct AlignedPath {
  std::vector<PathSample> path;
  std::optional<Pose> mesh_from_path; // absent: it was not laid yet
};
// Throws FileError. The scan has a path.
AlignedPath alignedPathOf(const SceneScan& scan);

// The scene's scan of this name, or one of its own for a path that came from a file, with the path
// where it lies.
SceneScan withAlignment(const Scene& scene, const std::string& name, const Alignment& alignment);

} // namespace patina
