// Points as CSV: x [m],y [m],z [m], or a tip's path, whose times do not matter here.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/csv.h"
#include "core/types.h"

namespace patina::cli {

// Further columns are ignored. Throws FileError with the line: another header, a bad number.
class PointReader {
 public:
  explicit PointReader(const std::filesystem::path& path);
  std::optional<Vec3> next(); // nullopt at the end

 private:
  CsvReader rows_;
  std::size_t first_ = 0; // the column of x
  std::vector<double> row_;
};

} // namespace patina::cli
