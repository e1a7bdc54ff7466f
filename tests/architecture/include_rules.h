// Who may include whom (docs/architecture.md), as a pure function of a file's path and text.
#pragma once

#include <string>
#include <vector>

namespace patina::architecture {

struct SourceFile {
  std::string path; // relative to the project's root, "modules/field/surface/models.cpp"
  std::string text;
};

// One line for each #include that the rules forbid: "path:line: cause".
std::vector<std::string> includeViolations(const SourceFile& file);

} // namespace patina::architecture
