#include "app/cli/input/point_file.h"

#include "visualization/export/export_files.h"

namespace patina::cli {

PointReader::PointReader(const std::filesystem::path& path)
    : rows_(path, {{"x [m]", "y [m]", "z [m]"}, {}, toolSampleColumns()}) {}

std::optional<Vec3> PointReader::next() {
  if (!rows_.next(row_)) return std::nullopt;
  return Vec3(row_[0], row_[1], row_[2]);
}

} // namespace patina::cli
