// What must not stay on disk if the program ends before it is finished.
#pragma once

#include <filesystem>
#include <list>

namespace patina {

// A file or folder that is being made. Known to removeUnfinished() until done() or the end of this.
// Any thread.
class Unfinished {
 public:
  Unfinished() = default;
  explicit Unfinished(const std::filesystem::path& path);
  ~Unfinished() { done(); }
  Unfinished(Unfinished&& other) noexcept;
  Unfinished& operator=(Unfinished&& other) noexcept;
  void done() noexcept; // whole, or gone already

 private:
  std::list<std::filesystem::path>::iterator place_{};
  bool held_ = false;
};

// Removes all of them, folders with what is in them. Whoever begins or finishes one after this
// waits for ever: for a process that ends at once.
void removeUnfinished() noexcept;

} // namespace patina
