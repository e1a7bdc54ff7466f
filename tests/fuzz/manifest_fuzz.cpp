// Any bytes give a workspace.json or state that reads back the same, or a FileError.
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
    const patina::Manifest manifest = patina::parseManifest(bytes, "fuzz");
    for (const patina::ContentFile& file : filesOf(manifest))
      if (file.path.empty() || file.path.front() == '/') std::abort();
    text = toJson(manifest).dump();
  } catch (const patina::FileError&) {
    return 0;
  }
  if (toJson(patina::parseManifest(text, "written")).dump() != text) std::abort();
  return 0;
}
