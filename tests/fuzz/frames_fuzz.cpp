// Any bytes give a list of frames or a FileError.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "acquisition/files/frame_files.h"
#include "core/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(std::string_view(reinterpret_cast<const char*>(data), size));
  try {
    (void)patina::parseFrameList(text, "fuzz");
  } catch (const patina::FileError&) {
  }
  return 0;
}
