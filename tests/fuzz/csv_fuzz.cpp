// Any bytes give a table or a FileError, and the same table if they come in pieces or are written.
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

// Returns the number of rows, or nothing if the text is rejected.
std::optional<std::size_t> rowsIn(std::string_view text, std::size_t piece) {
  std::string written = patina::csvHeader({"t [s]", "x [m]", "sigma [m]"});
  std::size_t rows = 0;
  try {
    patina::CsvReader reader(
        [text, piece](char* buffer, std::size_t capacity) mutable {
          const std::size_t count = text.copy(buffer, std::min(piece, capacity));
          text.remove_prefix(count);
          return count;
        },
        "fuzz", {{"t [s]", "x [m]"}, {"sigma [m]"}});
    for (std::vector<double> row; reader.next(row); ++rows) {
      if (row.size() != 3) std::abort();
      written += patina::csvRow(row);
    }
    (void)reader.leftOut();
  } catch (const patina::FileError&) {
    return std::nullopt;
  }
  if (patina::parseCsv(written, "written", {"t [s]"}).rows.size() != rows) std::abort();
  return rows;
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
