// The bytes are an archive, or a main.xml followed by a zero and the points of a valid archive, so
// that both layers are reached.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/check_heights.h"
#include "support/profilometer_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  patina::test::checkHeights(bytes);
  if (bytes.starts_with("PK")) return 0;
  const std::size_t end = bytes.find('\0');
  const std::string points(end == bytes.npos ? "" : bytes.substr(end + 1));
  patina::test::checkHeights(
      patina::test::storedZip({{"main.xml", std::string(bytes.substr(0, end))},
                               {"bindata/data.bin", points},
                               {"bindata/valid.bin", points}}));
  return 0;
}
