#include "pictures/image_library.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/loaded_library.h"
#include "core/memory_left.h"

namespace patina {

const ImageLibrary& imageLibrary(const std::string& name) {
  static std::string cause;
  static void* const symbol = [&] {
    requireRoomToLoad(name + ": the library of pictures");
    return loadedSymbol("patina_images.so", kImageLibrarySymbol, cause);
  }();
  if (!symbol)
    throw FileError(name, 0,
                    "needs Patina's library of pictures, which cannot be loaded: " + cause);
  return *reinterpret_cast<ImageLibraryFunction*>(symbol)();
}

void requireFinite(const ImageRows& rows, const std::string& name) {
  if (!std::all_of(rows.value.begin(), rows.value.end(), [](float v) { return std::isfinite(v); }))
    throw FileError(name, 0, "holds a value that is not a finite number");
}

} // namespace patina
