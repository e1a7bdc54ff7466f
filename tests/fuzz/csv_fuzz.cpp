// Whatever the bytes: a table, or a FileError.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/csv.h"
#include "core/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    patina::parseCsv(std::string(bytes), "fuzz", {"t [s]", "x [m]"});
  } catch (const patina::FileError&) {
  }
  return 0;
}
