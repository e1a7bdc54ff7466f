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

// The name of a temporary file of writeFileAtomically() for `filename`, in whatever process: what
// a killed one leaves behind.
bool isTemporaryFor(std::string_view filename, std::string_view candidate);

// Folders that are missing on the way to `folder` are made, and are there after a loss of power
// too. Throws FileError.
void makeFolder(const std::filesystem::path& folder);

} // namespace patina
