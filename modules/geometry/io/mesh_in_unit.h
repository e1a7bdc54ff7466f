// A mesh in metres as a file whose numbers are in another unit.
#pragma once

#include <filesystem>

#include "geometry/mesh/mesh_unit.h"

namespace patina {

// As writeMesh() does; `unit` is not MeshUnit::fit, which is for reading.
void writeMeshIn(const std::filesystem::path& path, TriangleMesh mesh, MeshUnit unit);

} // namespace patina
