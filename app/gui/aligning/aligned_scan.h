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

// The path and where it lies, as a scan of this name has them.
SceneScan alignedScan(const std::string& name, const Alignment& alignment);
// The scene's scan of that name, or nullptr, with where its path lies. Throws Error where it has
// another path.
SceneScan withAlignment(const SceneScan* known, const SceneScan& aligned);

} // namespace patina
