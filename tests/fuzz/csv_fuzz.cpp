// Whatever the bytes: a table, or a FileError; and the same table where they come in pieces.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/csv.h"
#include "core/error.h"

namespace {

// The number of rows, or none where the text is refused.
std::optional<std::size_t> rowsIn(std::string_view text, std::size_t piece) {
  try {
    patina::CsvReader reader(
        [text, piece](char* buffer, std::size_t capacity) mutable {
          const std::size_t count = text.copy(buffer, std::min(piece, capacity));
          text.remove_prefix(count);
          return count;
        },
        "fuzz", {{"t [s]", "x [m]"}, {"sigma [m]"}});
    std::size_t rows = 0;
    for (std::vector<double> row; reader.next(row); ++rows)
      if (row.size() != 3) std::abort();
    (void)reader.leftOut();
    return rows;
  } catch (const patina::FileError&) {
    return std::nullopt;
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (rowsIn(bytes, 7) != rowsIn(bytes, bytes.size() + 1)) std::abort();
  try {
    patina::parseCsv(std::string(bytes), "fuzz", {"t [s]", "x [m]"});
  } catch (const patina::FileError&) {
  }
  return 0;
}
