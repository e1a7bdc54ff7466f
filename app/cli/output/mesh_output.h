// Writes meshes; the files contain numbers in some unit but do not name it.
#pragma once

#include <filesystem>

#include "app/cli/framework/command.h"
#include "geometry/mesh/mesh_unit.h"

namespace patina::cli {

// --unit mm|cm|m|in of the numbers in the file; default mm, as for reading.
Argument unitOfOutput(MeshUnit& unit);
// Before any work: whether a mesh of that name can be written at all. Throws FileError; Error for
// MeshUnit::fit, which is for reading.
void requireMeshOutput(const std::filesystem::path& path, MeshUnit unit,
                       const std::vector<std::filesystem::path>& inputs = {});

} // namespace patina::cli
