// What must not stay on disk if the program ends before it is finished.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <list>
#include <string>

namespace patina {

// A file or folder that is being made. Known to removeUnfinished() until done() or the end of this.
// Any thread.
class Unfinished {
 public:
  struct Place {
    std::filesystem::path path;
    std::string whole; // the file in it that says that somebody has finished it; may be empty
  };
  Unfinished() = default;
  explicit Unfinished(const std::filesystem::path& path, const std::string& whole = {});
  ~Unfinished() { done(); }
  Unfinished(Unfinished&& other) noexcept;
  Unfinished& operator=(Unfinished&& other) noexcept;
  void done() noexcept; // whole, or gone already
  // The call that makes it whole, such as a rename, and done() if that returns 0:
  // removeUnfinished() comes before both or after both. Returns what `last` does.
  int finish(const std::function<int()>& last);

 private:
  std::list<Place>::iterator place_{};
  bool held_ = false;
};

// A folder that was not there before: gone again with what is in it, unless kept, or finished by
// another program meanwhile. One that was there stays whatever happens.
class NewFolder {
 public:
  // The folder is made by who uses it; `whole` is the file in it that comes last. Throws FileError.
  NewFolder(const std::filesystem::path& folder, const std::string& whole);
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  void keep() noexcept;

 private:
  void giveSpareBack() noexcept;

  Unfinished::Place place_;
  Unfinished unfinished_;
  std::array<int, 2> spare_{-1, -1}; // descriptors for the removal, where all others are in use
  bool kept_ = false;
};

// Removes all of them, folders with what is in them. Whoever begins or finishes one after this
// waits for ever: for a process that ends at once.
void removeUnfinished() noexcept;
// Whether a folder was kept, or a file finished that lies in no unfinished folder: an output is
// whole.
bool anyFinished() noexcept;

} // namespace patina
