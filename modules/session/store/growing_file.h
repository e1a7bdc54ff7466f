// A file that grows while a program runs and outlives its sudden end.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "core/append_file.h"

namespace patina {

// A thread of its own appends what was added and flushes it to disk twice a second, so that no call
// but flush() waits for the disk. A killed program loses at most the last second. If the disk is
// full or slow, what was added waits in memory, up to a limit; it is tried again each time.
class GrowingFile {
 public:
  static constexpr std::size_t kMostWaiting = std::size_t{3} << 20; // bytes; at most twice are held

  // Replaces the file at `path` at once by one that holds `first`, and locks it. Writes to the
  // target of a link, and directly to pipes, devices and "-". Throws FileError, also if another
  // GrowingFile holds it.
  GrowingFile(const std::filesystem::path& path, std::string_view first);
  ~GrowingFile(); // writes the rest; call flush() to learn whether that succeeds
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  // One thread at a time. Returns false and drops all of the bytes if too many wait.
  bool append(std::string_view bytes);
  // Returns when all bytes are on disk. Throws FileError if they cannot be written now; they wait
  // on, but for a pipe or device, which takes no more.
  void flush();
  std::string problem() const; // why the last attempt failed, in one line; empty: it did not

 private:
  void run();
  void write(std::string_view bytes);

  std::string name_;
  std::unique_ptr<AppendFile> file_; // null for a stream
  Descriptor stream_{-1};

  mutable std::mutex mutex_; // guards all below
  std::condition_variable wakes_, done_;
  std::string waiting_, writing_; // the latter belongs to the thread while it writes
  std::uint64_t added_ = 0, written_ = 0, failures_ = 0;
  std::exception_ptr problem_;
  bool asked_ = false, stopping_ = false, broken_ = false;
  std::thread thread_; // must be last
};

} // namespace patina
