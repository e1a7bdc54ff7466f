// Whole-file input and crash-safe output.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/descriptor.h"
#include "core/output_target.h"
#include "core/partial_output.h"

namespace patina {

// Reads the whole file as bytes; "-" is standard input. Throws FileError (missing, a folder,
// unreadable, a pipe without a writer).
std::string readFile(const std::filesystem::path& path);

// Writes a file that appears at `path` only when complete: temporary file in the same folder,
// fsync, rename, fsync of the folder. Without commit(), or on failure, the old file stays untouched
// and the temporary file is removed. Follows links to their target. Writes directly to pipes,
// devices and "-". All members throw FileError, also for a read-only file; the caller checks the
// kind of an existing file (file_kind.h).
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  void append(std::string_view bytes);
  // Call once. Returns false if the file is in its place but its folder could not be flushed, so
  // that a power loss may still undo it; warnOfOutput() then tells the user.
  bool commit();

 private:
  [[noreturn]] void fail(const std::string& what) const;
  void sendToDisk();

  std::string path_, folder_, temporary_; // temporary_ is empty after the rename
  OutputTarget target_;
  PartialOutput unfinished_;
  Descriptor file_;
  std::int64_t size_ = 0, sent_ = 0; // bytes; sent_: passed on for write-back
};

// Writes all bytes through an AtomicFile and returns what its commit() does.
bool writeFileAtomically(const std::filesystem::path& path, std::string_view bytes);
// The same, but throws DiskError where that returns false: for files that others will refer to.
void writeFileDurably(const std::filesystem::path& path, std::string_view bytes);

// True if `candidate` is the name of a temporary file of an AtomicFile for `filename`, of any
// process; a killed process leaves such files.
bool isTemporaryFor(std::string_view filename, std::string_view candidate);

// Creates `folder` and its missing parents, flushed to disk. Throws FileError, as outputTarget().
void makeFolder(const std::filesystem::path& folder);

} // namespace patina
