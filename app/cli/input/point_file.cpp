#include "app/cli/input/point_file.h"

#include <algorithm>

#include "core/error.h"

namespace patina::cli {

namespace {

const std::vector<std::string> kColumns = {"x [m]", "y [m]", "z [m]"};
constexpr const char* kHeader = "must be 'x [m],y [m],z [m]' or, of a path, 't [s],x [m],y [m],z "
                                "[m]'; more columns may follow";

// Either header is right, so that the reader itself can expect neither.
CsvReader opened(const std::filesystem::path& path) {
  std::error_code unknown;
  if (std::filesystem::is_regular_file(path, unknown) &&
      std::filesystem::file_size(path, unknown) == 0)
    throw FileError(path.string(), 0, std::string("is empty: its first line ") + kHeader);
  return CsvReader(path, {});
}

} // namespace

PointReader::PointReader(const std::filesystem::path& path) : rows_(opened(path)) {
  const std::vector<std::string>& columns = rows_.columns();
  first_ = columns.front() == "t [s]" ? 1 : 0;
  if (columns.size() < first_ + 3 ||
      !std::equal(kColumns.begin(), kColumns.end(), columns.begin() + static_cast<long>(first_)))
    throw FileError(path.string(), 1, std::string("the header ") + kHeader);
}

std::optional<Vec3> PointReader::next() {
  if (!rows_.next(row_)) return std::nullopt;
  return Vec3(row_[first_], row_[first_ + 1], row_[first_ + 2]);
}

} // namespace patina::cli
