// Writes several files that become visible in a folder together.
#pragma once

#include <filesystem>
#include <string>

#include "core/partial_output.h"

namespace patina {

// The files are written into a hidden folder within `folder`, which is created if missing;
// subfolders are allowed. commit() moves them into place. Without it they are removed, and earlier
// files stay unchanged. All members throw FileError.
class StagedFolder {
 public:
  // `index_file` is the file whose presence marks the output as complete.
  StagedFolder(const std::filesystem::path& folder, const std::string& index_file);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& path() const { return staging_; } // folder to write to
  // Removes an old index file first and moves the new one last. Checks for read-only files and
  // files of another kind before it moves any. Call once.
  void commit();

 private:
  std::filesystem::path folder_, staging_;
  std::string index_file_;
  NewFolder fresh_;
  PartialOutput unfinished_;
};

// True if a process was killed while it wrote into the folder. Its files are not a complete output;
// the next commit() replaces them and removes the rest.
bool isInterruptedWrite(const std::filesystem::path& folder);

} // namespace patina
