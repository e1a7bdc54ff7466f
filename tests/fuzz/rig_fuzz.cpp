// Whatever the bytes: a probe and its markers, or a FileError.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "acquisition/files/scan_files.h"
#include "core/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(std::string_view(reinterpret_cast<const char*>(data), size));
  try {
    (void)patina::parseRig(text, "fuzz");
  } catch (const patina::FileError&) {
  }
  try {
    (void)patina::parseMarkers(text, "fuzz");
  } catch (const patina::FileError&) {
  }
  return 0;
}
