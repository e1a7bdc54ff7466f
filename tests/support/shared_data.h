// Real data that does not ship with the program: tests that use it skip if it is absent.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/places.h"

namespace patina::test {

// The folder is named by PATINA_SHARED_DATA, or lies beside the source tree.
inline std::filesystem::path sharedData(const std::string& relative) {
  const char* folder = std::getenv("PATINA_SHARED_DATA");
  const std::filesystem::path root = folder ? folder : sourceFolder() / ".." / "shared" / "data";
  return root / relative;
}

} // namespace patina::test

#define PATINA_SKIP_WITHOUT(path)                                                                  \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << (path) << " is absent"
