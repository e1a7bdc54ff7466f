// Any bytes give heights or a FileError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/check_heights.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  patina::test::checkHeights({reinterpret_cast<const char*>(data), size});
  return 0;
}
