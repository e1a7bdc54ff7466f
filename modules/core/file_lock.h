// Locks a file or a folder against other programs, with or without the file system's help.
#pragma once

#include <filesystem>
#include <string>

#include "core/descriptor.h"

namespace patina {

// Held while the object lives. Where the file system refuses locks (NFS, Lustre, some FUSE), a lock
// file takes their place: ".NAME.lock" beside the file, or ".lock" in the folder. It
// appears at once with the names of host, process and time. One whose process has ended on this
// machine is removed; any other counts, because only its user can know whether that program still
// runs. warnOfOutput() then tells the user.
class FileLock {
 public:
  enum class Wait { no, yes };
  // `descriptor` is open on `path` and outlives the lock. Throws FileError if another program or
  // another FileLock holds the lock, with Wait::yes only after a minute beside a lock file.
  FileLock(int descriptor, const std::filesystem::path& path, Wait wait);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::string lock_file_, content_; // empty where the file system has locks
};

// True for the name of a folder's own lock file, also of an abandoned one.
bool isFolderLockFile(const std::string& name);

// Lock of a folder that one writer at a time may change: waits until no other FolderLock on the
// folder exists, in this process or another. Must not be nested, or the second waits for the first.
class FolderLock {
 public:
  // Throws FileError if the folder cannot be opened or locked.
  explicit FolderLock(const std::filesystem::path& folder);

 private:
  Descriptor folder_;
  FileLock lock_;
};

} // namespace patina
