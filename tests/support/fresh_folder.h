// A place for a test's files.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace patina::test {

// A new folder that no other test, nor what a killed one has left, can have. Whoever asks removes
// it.
inline std::filesystem::path
freshFolder(const std::string& what,
            const std::filesystem::path& base = std::filesystem::temp_directory_path()) {
  std::string path = base / ("patina-" + what + "-XXXXXX");
  if (!::mkdtemp(path.data())) throw std::runtime_error("no folder " + path);
  return path;
}

} // namespace patina::test
