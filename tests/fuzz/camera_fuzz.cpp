// Any bytes give a camera that is written and reads back the same, or a FileError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "acquisition/files/camera_file.h"
#include "core/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(std::string_view(reinterpret_cast<const char*>(data), size));
  std::string written;
  try {
    written = patina::cameraText(patina::parseCamera(text, "fuzz"));
  } catch (const patina::FileError&) {
    return 0;
  }
  if (patina::cameraText(patina::parseCamera(written, "written")) != written) std::abort();
  return 0;
}
