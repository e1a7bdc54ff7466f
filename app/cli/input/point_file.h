// Points as a table with x [m], y [m], z [m]; the times of a path do not matter here.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/csv.h"
#include "core/types.h"

namespace patina::cli {

// Throws FileError with the line: another header, a bad number.
class PointReader {
 public:
  explicit PointReader(const std::filesystem::path& path);
  std::optional<Vec3> next(); // nullopt at the end
  const CsvReader& table() const { return rows_; }

 private:
  CsvReader rows_;
  std::vector<double> row_;
};

} // namespace patina::cli
