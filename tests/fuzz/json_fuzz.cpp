// Whatever the bytes: a value that reads back the same, or a FileError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text;
  try {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    text = patina::parseJson(bytes, "fuzz").dump(-1);
  } catch (const patina::FileError&) {
    return 0;
  }
  if (patina::parseJson(text, "written").dump(-1) != text) std::abort();
  return 0;
}
