// A place for a test's files.
#pragma once

#include <filesystem>
#include <random>
#include <string>

namespace patina::test {

// A new folder that no other test, nor what a killed one has left, can have. Whoever asks removes
// it. In small letters and digits, which a test can type.
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

} // namespace patina::test
