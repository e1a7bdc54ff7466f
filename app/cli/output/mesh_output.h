// Meshes that commands write: a file has numbers in some unit, and no word of it.
#pragma once

#include <filesystem>

#include "app/cli/commands/command.h"
#include "geometry/mesh/mesh_unit.h"

namespace patina::cli {

// --unit mm|cm|m|in, of the numbers in the file; mm, as files are read, unless chosen.
Argument unitOfOutput(MeshUnit& unit);
// `mesh` in metres. Throws FileError; Error for MeshUnit::fit, which is for reading.
void writeMeshIn(const std::filesystem::path& path, TriangleMesh mesh, MeshUnit unit);
// Before any work: whether a mesh of that name can be written at all.
void requireMeshOutput(const std::filesystem::path& path, MeshUnit unit,
                       const std::vector<std::filesystem::path>& inputs = {});

} // namespace patina::cli
