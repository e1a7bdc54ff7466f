// Scenes without a folder of their own, kept where a crash leaves them and a clean end does not.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/append_file.h"

namespace patina {

// $XDG_STATE_HOME/patina, or ~/.local/state/patina.
std::filesystem::path stateFolder();

// One scene's place: a folder locked for as long as this lives. Throws FileError.
class Autosave {
 public:
  // A new place below `root`, which is made; removed with this.
  explicit Autosave(const std::filesystem::path& root);
  // What another program left behind. It stays when this ends, for the next start to offer it
  // again, unless own() said that somebody has its scene.
  static std::unique_ptr<Autosave> adopt(const std::filesystem::path& place);
  ~Autosave();
  Autosave(const Autosave&) = delete;
  Autosave& operator=(const Autosave&) = delete;

  void own() { removes_ = true; }
  void leave() { removes_ = false; } // for the next start to offer it

  std::filesystem::path workspace() const; // the folder for the scene; made by whoever saves it

 private:
  struct Existing {};
  Autosave(Existing, const std::filesystem::path& place);
  std::filesystem::path place_;
  bool removes_ = false;
  std::unique_ptr<AppendFile> lock_;
};

// Places below `root` that hold a workspace and that no program has locked, newest first. Never
// throws.
std::vector<std::filesystem::path> leftBehind(const std::filesystem::path& root);

} // namespace patina
