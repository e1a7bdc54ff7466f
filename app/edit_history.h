// Undo and redo of every edit: records, and scenes to begin again from.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/edit.h"

namespace patina {

// The scene after each edit is kept as long as all together stay within a budget; tiles, blocks and
// meshes that scenes share count once. Beyond it scenes of the past are thinned out, ever more the
// farther they lie back, and made again from the nearest one before by replaying records, which
// gives the same bits. Scenes that no record makes are never dropped. One thread.
class EditHistory {
 public:
  using Replay = std::function<Scene(const Scene& before, const Edit& edit)>;

  EditHistory(Scene start, Replay replay, std::size_t budget_bytes);

  const Scene& scene() const;                    // at the present position
  std::size_t undoable() const;                  // edits before it
  std::size_t redoable() const;                  // edits after it
  std::vector<std::string> descriptions() const; // of all edits, oldest first
  const Edit& edit(std::size_t index) const;

  // Drops what could be redone.
  void append(Edit edit, Scene after);
  // Slow where a scene must be replayed. False and nothing changed if there is no such step.
  bool undo(std::size_t steps = 1);
  bool redo(std::size_t steps = 1);

  std::size_t bytes() const;  // of paint that the kept scenes hold, shared parts once
  std::size_t scenes() const; // kept

 private:
  struct Entry {
    Edit edit;
    std::optional<Scene> after;
  };
  void thin();
  Scene sceneAt(std::size_t position) const;

  Scene start_;
  Replay replay_;
  std::size_t budget_;
  std::vector<Entry> entries_;
  std::size_t position_ = 0;
  Scene present_;
};

} // namespace patina
