#include "pictures/image_library.h"

#include <algorithm>
#include <cmath>
#include <dlfcn.h>
#include <filesystem>
#include <vector>

#include "core/error.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

// In the build tree beside the program, in an installed one where libraries are.
std::vector<fs::path> places() {
  std::error_code code;
  const fs::path folder = fs::read_symlink("/proc/self/exe", code).parent_path();
  return {folder / PATINA_IMAGES_FILE,
          (folder / PATINA_IMAGES_FOLDER / PATINA_IMAGES_FILE).lexically_normal()};
}

const ImageLibrary* load(std::string& cause) {
  std::error_code code;
  for (const fs::path& place : places()) {
    if (!fs::exists(place, code)) continue;
    void* library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* symbol = library ? ::dlsym(library, kImageLibrarySymbol) : nullptr;
    if (symbol) return reinterpret_cast<ImageLibraryFunction*>(symbol)();
    const char* error = ::dlerror();
    cause = error ? error : place.string() + " is another version's";
    return nullptr;
  }
  cause = "it is neither " + places()[0].string() + " nor " + places()[1].string();
  return nullptr;
}

} // namespace

const ImageLibrary& imageLibrary(const std::string& name) {
  static std::string cause;
  static const ImageLibrary* const library = load(cause);
  if (!library)
    throw FileError(name, 0,
                    "needs Patina's library of pictures, which cannot be loaded: " + cause);
  return *library;
}

void requireFinite(const ImageRows& rows, const std::string& name) {
  if (!std::all_of(rows.value.begin(), rows.value.end(), [](float v) { return std::isfinite(v); }))
    throw FileError(name, 0, "holds a value that is not a finite number");
}

} // namespace patina
