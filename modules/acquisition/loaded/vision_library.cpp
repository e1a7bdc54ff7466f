#include "acquisition/loaded/vision_library.h"

#include "core/error.h"
#include "core/loaded_library.h"
#include "core/memory_left.h"

namespace patina {

const VisionLibrary& visionLibrary() {
  static std::string cause;
  static void* const symbol = [] {
    requireRoomToLoad("the library of vision");
    return loadedSymbol("patina_vision.so", kVisionLibrarySymbol, cause);
  }();
  if (!symbol)
    throw Error("markers need Patina's library of vision, which cannot be loaded: " + cause);
  return *reinterpret_cast<VisionLibraryFunction*>(symbol)();
}

} // namespace patina
