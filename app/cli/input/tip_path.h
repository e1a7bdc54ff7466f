// Recorded tip path from a table with t [s], x [m], y [m], z [m].
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/csv.h"
#include "haptics/servo/feel.h"

namespace patina::cli {

// Throws FileError with the line: wrong header, invalid number, time that does not increase, no
// row.
class TipPathReader {
 public:
  explicit TipPathReader(const std::filesystem::path& path);
  std::optional<TimedTip> next(); // nullopt at the end
  const CsvReader& table() const { return rows_; }

 private:
  CsvReader rows_;
  std::string name_;
  std::vector<double> row_;
  std::optional<double> last_;
};

} // namespace patina::cli
