#include "app/cli/input/tip_path.h"

#include <cmath>

#include "core/csv.h"
#include "core/error.h"

namespace patina::cli {

std::vector<TimedTip> readTipPath(const std::filesystem::path& path) {
  const CsvTable table = readCsv(path, {"t [s]", "x [m]", "y [m]", "z [m]"});
  if (table.rows.empty()) throw FileError(path.string(), 0, "there is no tip in it");
  std::vector<TimedTip> tips;
  tips.reserve(table.rows.size());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    if (!std::isfinite(row[0])) throw FileError(path.string(), i + 2, "time is not a number");
    if (i && !(row[0] > tips.back().t))
      throw FileError(path.string(), i + 2, "time does not increase");
    tips.push_back({row[0], {row[1], row[2], row[3]}});
  }
  return tips;
}

} // namespace patina::cli
