#include "core/loaded_library.h"

#include <dlfcn.h>

namespace patina {

namespace fs = std::filesystem;

std::vector<fs::path> libraryFolders() {
  std::error_code code;
  const fs::path beside = fs::read_symlink("/proc/self/exe", code).parent_path();
  return {beside, (beside / PATINA_LIBRARIES_FOLDER).lexically_normal()};
}

void* loadedSymbol(const std::string& file, const char* symbol, std::string& cause) {
  std::error_code code;
  std::string places;
  for (const fs::path& folder : libraryFolders()) {
    const fs::path place = folder / file;
    places += (places.empty() ? "" : " nor ") + place.string();
    if (!fs::exists(place, code)) continue;
    void* library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* found = library ? ::dlsym(library, symbol) : nullptr;
    if (found) return found;
    const char* error = ::dlerror();
    cause = error ? error : place.string() + " is another version's";
    return nullptr;
  }
  cause = "it is neither " + places;
  return nullptr;
}

} // namespace patina
