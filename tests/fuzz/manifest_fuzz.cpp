// Whatever the bytes: a workspace.json or state that reads back the same, or a FileError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/error.h"
#include "workspace/manifest.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text;
  try {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    text = toJson(patina::parseManifest(bytes, "fuzz")).dump();
  } catch (const patina::FileError&) {
    return 0;
  }
  if (toJson(patina::parseManifest(text, "written")).dump() != text) std::abort();
  return 0;
}
