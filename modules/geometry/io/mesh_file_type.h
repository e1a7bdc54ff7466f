// The format that a mesh file's name asks for. Internal to reading and writing.
#pragma once

#include <filesystem>

namespace patina {

enum class MeshFileType { obj, ply, stl };

// By the extension, in any case. Throws FileError naming the choices.
MeshFileType meshFileType(const std::filesystem::path& path);

} // namespace patina
