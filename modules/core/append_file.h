// A file that grows by whole pieces, and by one program at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/descriptor.h"

namespace patina {

// A file that is new, without waiting for the disk: a loss of power may take it, the end of the
// program does not. Where it fails nothing is left of it. Throws FileError, also if it exists.
void createFile(const std::filesystem::path& path, std::string_view bytes);

// Holds a lock on the file for as long as it lives.
class AppendFile {
 public:
  // The file must exist. Throws FileError: missing, or locked by another program (or another
  // AppendFile of this one).
  explicit AppendFile(const std::filesystem::path& path);

  std::string content() const;
  std::uint64_t size() const { return size_; }
  void truncate(std::uint64_t size); // on disk when it returns; throws FileError
  // On disk when it returns. On failure throws FileError, and the file ends where it ended before;
  // if even that is refused, the next append() tries it again first. A file that was removed or
  // replaced meanwhile is a failure.
  void append(std::string_view bytes);

 private:
  bool cut(std::uint64_t size);

  std::string name_;
  Descriptor file_;
  std::uint64_t size_ = 0;
  bool longer_ = false; // a piece that failed could not be cut off
};

} // namespace patina
