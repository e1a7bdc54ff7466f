// Autosave of scenes and recordings without a file of the user's: it survives a crash and is
// removed at a clean exit.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/append_file.h"

namespace patina {

// $XDG_STATE_HOME/patina, or ~/.local/state/patina; without HOME the user's own folder in /tmp.
std::filesystem::path stateFolder();

// Folder of one scene or recording, locked while this object lives. Throws FileError.
class Autosave {
 public:
  // Makes a new folder below `root`, which must belong to the user; the destructor removes it.
  explicit Autosave(const std::filesystem::path& root);
  // Adopts a folder that another program left behind. The destructor keeps it for the next start,
  // unless claim() was called for its scene.
  static std::unique_ptr<Autosave> adopt(const std::filesystem::path& place);
  ~Autosave();
  Autosave(const Autosave&) = delete;
  Autosave& operator=(const Autosave&) = delete;

  void claim() { removes_ = true; }
  void keepForRecovery() { removes_ = false; } // the next start offers it again

  std::filesystem::path workspace() const; // the folder for the scene; the first save makes it
  std::filesystem::path recording() const; // the file for a recording of forces

 private:
  struct Existing {};
  Autosave(Existing, const std::filesystem::path& place);
  std::filesystem::path place_;
  bool removes_ = false;
  std::unique_ptr<AppendFile> lock_;
};

// Folders below `root` that belong to the user, hold a scene or a recording, and that no program
// has locked, newest first. Never throws.
std::vector<std::filesystem::path> recoverableScenes(const std::filesystem::path& root);
bool holdsRecording(const std::filesystem::path& place); // instead of a scene

} // namespace patina
