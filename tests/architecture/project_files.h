// The project's own files as text, for rules that are checked on them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "support/places.h"

namespace patina::architecture {

inline const std::filesystem::path kRoot = test::sourceFolder();

struct SourceFile {
  std::string path; // relative to the project's root, "modules/field/surface/models.cpp"
  std::string text;
};

bool isCode(const std::filesystem::path& path);
bool isDocument(const std::filesystem::path& path);

// Returns the wanted files below the folders, which may be missing; a file may stand for a folder.
std::vector<SourceFile> filesUnder(const std::vector<std::string>& folders,
                                   bool (*wanted)(const std::filesystem::path&));

} // namespace patina::architecture
