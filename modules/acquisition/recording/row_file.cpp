#include "acquisition/recording/row_file.h"

namespace patina {

namespace {
constexpr std::size_t kPage = 4096;
}

RowFile::RowFile(const std::filesystem::path& path, const std::string& header)
    : size_(header.size()) {
  createFile(path, header);
  file_.emplace(path);
}

void RowFile::add(std::string row) {
  if (row.size() > kLongestRow) row.replace(kLongestRow - 1, std::string::npos, 1, '\n');
  // Where the program is killed while it writes, the system stops between two pages. So no row lies
  // in both, and none is left half; blanks before a line's end say nothing.
  const std::size_t left = kPage - (size_ + row.size()) % kPage;
  if (left < kLongestRow) row.insert(row.size() - 1, left, ' ');
  size_ += row.size();
  pending_ += row;
}

void RowFile::write(const std::string& pending) {
  if (!pending.empty()) file_->append(pending);
}

} // namespace patina
