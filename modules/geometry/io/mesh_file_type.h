// The format that a mesh file's name asks for. Internal to reading and writing.
#pragma once

#include <filesystem>
#include <string_view>

namespace patina {

enum class MeshFileType { obj, ply, stl };

// By the extension, in any case. Throws FileError naming the choices. A stream ("-" or what is
// below /dev) has none: PLY is written to it.
MeshFileType meshFileType(const std::filesystem::path& path);
// The same to read `bytes` by: those of a stream say themselves what they are.
MeshFileType meshFileType(const std::filesystem::path& path, std::string_view bytes);

} // namespace patina
