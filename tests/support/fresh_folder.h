// Folders for a test's files.
#pragma once

#include <filesystem>
#include <random>
#include <string>
#include <unistd.h>

namespace patina::test {

// Makes a new folder that neither another test nor a killed one can have. The caller removes it.
// The name has small letters and digits, which a test can type.
inline std::filesystem::path
freshFolder(const std::string& what,
            const std::filesystem::path& base = std::filesystem::temp_directory_path()) {
  std::random_device random;
  std::filesystem::path path;
  do {
    path = base / ("patina-" + what + "-" + std::to_string(random()));
  } while (!std::filesystem::create_directory(path));
  return path;
}

// Makes a new folder whose code the program runs (core/ownership.h). Root runs code of system folders
// only, which neither /tmp is nor the build folder of another user.
inline std::filesystem::path trustedFolder(const std::string& what) {
  return ::geteuid() == 0 ? freshFolder(what, "/run") : freshFolder(what);
}

} // namespace patina::test
