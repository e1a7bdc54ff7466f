// A folder that one writer at a time changes.
#pragma once

#include <filesystem>

#include "core/descriptor.h"

namespace patina {

// Waits until no other FolderLock on the folder lives, in this process or another. Not to be nested
// on one folder: the second would wait for the first. Where a file system has no locks it holds
// nothing.
class FolderLock {
 public:
  // Throws FileError if the folder cannot be opened.
  explicit FolderLock(const std::filesystem::path& folder);

 private:
  Descriptor folder_;
};

} // namespace patina
