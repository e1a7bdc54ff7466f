// Any bytes give a material map that reads back the same, or a FileError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"
#include "workspace/paint_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::optional<patina::MaterialMap> map;
  try {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    map = patina::parseMaterial(bytes, "fuzz");
  } catch (const patina::FileError&) {
    return 0;
  }
  if (!same(*map, patina::parseMaterial(patina::materialBytes(*map), "written"))) std::abort();
  return 0;
}
