// Files and folders that are removed if the program ends before they are complete.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <list>
#include <string>
#include <vector>

namespace patina {

// Guards a file or folder while it is written: removeUnfinished() deletes it at process exit unless
// done() was called or this object was destroyed. Any thread.
class PartialOutput {
 public:
  struct Place {
    std::filesystem::path path;
    std::string completion_marker; // file whose presence marks the folder as complete; may be empty
  };
  PartialOutput() = default;
  explicit PartialOutput(const std::filesystem::path& path,
                         const std::string& completion_marker = {});
  ~PartialOutput() { done(); }
  PartialOutput(PartialOutput&& other) noexcept;
  PartialOutput& operator=(PartialOutput&& other) noexcept;
  void done() noexcept; // complete, or removed already
  // Calls `last`, such as a rename that completes the output, and done() if it returns 0;
  // removeUnfinished() runs before or after both. Returns the result of `last`.
  int finish(const std::function<int()>& last);

 private:
  std::list<Place>::iterator place_{};
  bool held_ = false;
};

// Removes a folder that did not exist before, with its content, unless keep() was called or its
// completion marker exists. A folder that existed before is never removed.
class NewFolder {
 public:
  // The caller creates the folder; its marker file is written last. Throws FileError.
  NewFolder(const std::filesystem::path& folder, const std::string& completion_marker);
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  void keep() noexcept;

 private:
  void releaseReserve() noexcept;

  PartialOutput::Place place_;
  PartialOutput unfinished_;
  std::array<int, 2> spare_{
      -1, -1}; // reserved descriptors, so that the removal works if all others are in use
  bool kept_ = false;
};

// Removes all guarded outputs at process exit. Threads that begin or finish one then block.
void removeUnfinished() noexcept;
// True if an output is complete: a folder was kept, or a file finished outside unfinished folders.
bool hasCompleteOutput() noexcept;

// Adds a line for the user about an output that is complete but less safe than usual. Each line
// counts once. Any thread.
void warnOfOutput(const std::string& line);
std::vector<std::string> takeOutputWarnings(); // the lines since the last call

} // namespace patina
