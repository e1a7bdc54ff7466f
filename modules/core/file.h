// Whole-file input and crash-safe output.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patina {

// The whole file as bytes. Throws FileError (missing, a folder, unreadable).
std::string readFile(const std::filesystem::path& path);

// Temp file in the same folder, write, fsync, rename, fsync folder. On any failure throws FileError
// and leaves what stood at `path` untouched.
void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes);

} // namespace patina
