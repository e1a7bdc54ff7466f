// A file that one program at a time extends by complete records.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/descriptor.h"
#include "core/file_lock.h"

namespace patina {

// Creates a file without waiting for the disk: it survives the end of the program, but a power loss
// may remove it. Removes the file again on failure. Throws FileError, also if the file exists.
void createFile(const std::filesystem::path& path, std::string_view bytes);

// Holds a lock on the file while the object exists.
class AppendFile {
 public:
  // Throws FileError if the file is missing or locked by another program or another AppendFile.
  explicit AppendFile(const std::filesystem::path& path);

  std::string content() const;
  std::uint64_t size() const { return size_; }
  void truncate(std::uint64_t size); // flushed to disk on return; throws FileError
  // Flushes the bytes to disk. On failure, also if the file was removed or replaced, throws
  // FileError and restores the previous length; if the disk refuses even that, the message says so
  // and the next append() tries again.
  void append(std::string_view bytes);

 private:
  bool cut(std::uint64_t size);

  std::string name_;
  Descriptor file_;
  FileLock lock_;
  std::uint64_t size_ = 0;
  bool longer_ = false; // a failed append could not be cut off
};

} // namespace patina
