// A mesh file that a command reads by itself, not as a scene.
#pragma once

#include <filesystem>

#include "app/cli/output/console.h"
#include "geometry/mesh/mesh_unit.h"

namespace patina::cli {

// readMesh() and inMetres(), with what they have to say as warnings.
ScaledMesh readScaledMesh(const std::filesystem::path& path, MeshUnit unit, Console& console);

} // namespace patina::cli
