#include "app/cli/input/tip_path.h"

#include <cmath>

#include "core/error.h"
#include "visualization/export/export_files.h"

namespace patina::cli {

TipPathReader::TipPathReader(const std::filesystem::path& path)
    : rows_(path, {{"t [s]", "x [m]", "y [m]", "z [m]"}, {}, toolSampleColumns()}),
      name_(path.string()) {}

std::optional<TimedTip> TipPathReader::next() {
  if (!rows_.next(row_)) {
    if (!last_) throw FileError(name_, 0, "there is no tip in it");
    return std::nullopt;
  }
  const double t = row_[0];
  if (!std::isfinite(t)) throw FileError(name_, rows_.line(), "t [s] is not a finite number");
  if (last_ && !(t > *last_)) throw FileError(name_, rows_.line(), "time does not increase");
  last_ = t;
  return TimedTip{t, {row_[1], row_[2], row_[3]}};
}

} // namespace patina::cli
