#include "core/loaded_library.h"

#include <dlfcn.h>
#include <filesystem>

namespace patina {

namespace fs = std::filesystem;

void* loadedSymbol(const std::string& file, const char* symbol, std::string& cause) {
  std::error_code code;
  const fs::path folder = fs::read_symlink("/proc/self/exe", code).parent_path();
  const fs::path beside = folder / file;
  const fs::path installed = (folder / PATINA_LIBRARIES_FOLDER / file).lexically_normal();
  for (const fs::path& place : {beside, installed}) {
    if (!fs::exists(place, code)) continue;
    void* library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* found = library ? ::dlsym(library, symbol) : nullptr;
    if (found) return found;
    const char* error = ::dlerror();
    cause = error ? error : place.string() + " is another version's";
    return nullptr;
  }
  cause = "it is neither " + beside.string() + " nor " + installed.string();
  return nullptr;
}

} // namespace patina
