// The only test source that depends on its build tree: all others compile equally in every tree.
#include "support/places.h"

#include <functional>

namespace patina::test {

std::filesystem::path sourceFolder() {
  return PATINA_SOURCE_DIR;
}

std::filesystem::path programFolder() {
  return PATINA_PROGRAM_DIR;
}

std::string preloadable(const std::string& library) {
  const std::filesystem::path built = programFolder() / library;
  if (built.string().find_first_of(" :") == std::string::npos) return built;
  const std::string name = std::to_string(std::hash<std::string>{}(built)) + "-" + library;
  const std::filesystem::path link = std::filesystem::temp_directory_path() / name;
  std::error_code there_already;
  std::filesystem::create_symlink(built, link, there_already);
  return link;
}

} // namespace patina::test
