// Reads a mesh file that is not opened as a scene.
#pragma once

#include <filesystem>

#include "app/cli/framework/command.h"
#include "geometry/mesh/mesh_unit.h"

namespace patina::cli {

// Calls readMesh() and inMetres() and prints their warnings.
ScaledMesh readScaledMesh(const std::filesystem::path& path, MeshUnit unit, Console& console);

// --unit UNIT of the mesh, millimetres unless it is given.
Argument unitOfMesh(MeshUnit& unit);
// --tip-radius of the probe that touched it.
Argument tipRadius(std::optional<double>& radius, const std::string& fallback);

} // namespace patina::cli
