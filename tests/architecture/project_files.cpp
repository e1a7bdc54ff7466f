#include "architecture/project_files.h"

#include <fstream>
#include <set>
#include <sstream>

namespace patina::architecture {

namespace fs = std::filesystem;

bool isCode(const fs::path& path) {
  static const std::set<std::string> kEndings{".h", ".cpp", ".sh", ".cmake"};
  return kEndings.contains(path.extension()) || path.filename() == "CMakeLists.txt";
}

bool isDocument(const fs::path& path) {
  return path.extension() == ".md";
}

std::vector<SourceFile> filesUnder(const std::vector<std::string>& folders,
                                   bool (*wanted)(const fs::path&)) {
  std::vector<SourceFile> files;
  const auto take = [&](const fs::path& path) {
    if (!fs::is_regular_file(path) || !wanted(path)) return;
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    files.push_back({fs::relative(path, kRoot).generic_string(), text.str()});
  };
  for (const std::string& folder : folders) {
    take(kRoot / folder);
    if (!fs::is_directory(kRoot / folder)) continue;
    for (const fs::directory_entry& item : fs::recursive_directory_iterator(kRoot / folder))
      take(item.path());
  }
  return files;
}

} // namespace patina::architecture
