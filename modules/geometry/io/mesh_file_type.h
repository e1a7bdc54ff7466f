// Determines the format of a mesh file. Internal to reading and writing.
#pragma once

#include <filesystem>
#include <string_view>

namespace patina {

enum class MeshFileType { obj, ply, stl };

// Returns the format by extension, in any case. Throws FileError naming the choices. A stream ("-"
// or a path below /dev) has no extension: PLY is written to it.
MeshFileType meshFileType(const std::filesystem::path& path);
// The same for reading `bytes`; the format of a stream follows from its content.
MeshFileType meshFileType(const std::filesystem::path& path, std::string_view bytes);

} // namespace patina
