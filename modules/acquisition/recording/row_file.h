// A table of a scan folder that grows while it is recorded, by whole rows.
#pragma once

#include <optional>
#include <string>

#include "core/append_file.h"

namespace patina {

// Rows are added by one thread, or under one lock, while another writes those before them.
class RowFile {
 public:
  static constexpr std::size_t kLongestRow = 512; // [bytes]

  // Makes it. Throws FileError.
  RowFile(const std::filesystem::path& path, const std::string& header);
  // With its line's end; what is longer than kLongestRow is cut.
  void add(std::string row);

  std::string takePending() {
    std::string pending;
    pending.swap(pending_);
    return pending;
  }
  void write(const std::string& pending); // on disk when it returns; throws FileError

 private:
  std::optional<AppendFile> file_;
  std::size_t size_ = 0; // with what is pending
  std::string pending_;
};

} // namespace patina
