// Whole-file input and crash-safe output.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/descriptor.h"
#include "core/output_target.h"
#include "core/unfinished.h"

namespace patina {

// The whole file as bytes; "-" is standard input. Throws FileError (missing, a folder, unreadable,
// a pipe that nobody writes).
std::string readFile(const std::filesystem::path& path);

// A file that is written piece by piece and stands at `path` only once it is whole: temp file in
// the same folder, writes, fsync, rename, fsync folder. Until commit() returns, and on any failure,
// what stood at `path` is untouched; without commit() the temp file is gone. Where `path` is a
// link, that is the file it leads to; what is no file (a pipe, a device, "-") is written as it
// comes. All throw FileError, also over a read-only file; whether what is there is of another kind
// is for the caller to ask (file_kind.h).
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  void append(std::string_view bytes);
  void commit(); // once

 private:
  [[noreturn]] void fail(const std::string& what) const;
  void sendToDisk();

  std::string path_, folder_, temporary_; // temporary_ is empty once it has been renamed
  OutputTarget target_;
  Unfinished unfinished_;
  Descriptor file_;
  std::int64_t size_ = 0, sent_ = 0; // bytes; sent_: on their way to the disk
};

// The whole of an AtomicFile.
void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes);

// The name of a temporary file of an AtomicFile for `filename`, in whatever process: what
// a killed one leaves behind.
bool isTemporaryFor(std::string_view filename, std::string_view candidate);

// Folders that are missing on the way to `folder` are made, and are there after a loss of power
// too. Throws FileError.
void makeFolder(const std::filesystem::path& folder);

} // namespace patina
