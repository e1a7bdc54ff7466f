// Several files that belong together and come into a folder together.
#pragma once

#include <filesystem>
#include <string>

#include "core/unfinished.h"

namespace patina {

// They are written into a hidden folder within `folder`, which is made if it is missing, and into
// folders in that; commit() moves them to where they belong. Without it nothing of them is left,
// and files that were there before are as they were. All throw FileError.
class StagedFolder {
 public:
  // `last` is the file that says that the others are whole.
  StagedFolder(const std::filesystem::path& folder, const std::string& last);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& path() const { return staging_; } // where to write
  // An old `last` goes first, the new one comes last. Refuses before it moves any: files of another
  // kind, read-only ones. Once.
  void commit();

 private:
  std::filesystem::path folder_, staging_;
  std::string last_;
  NewFolder fresh_;
  Unfinished unfinished_;
};

// Whether a run was killed while it wrote into the folder. What it has put in place is no scene,
// scan or study yet; the next commit() takes its place and removes the rest.
bool wasAbandoned(const std::filesystem::path& folder);

} // namespace patina
