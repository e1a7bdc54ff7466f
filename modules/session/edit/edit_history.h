// Undo and redo of every edit: records, and scenes to begin again from.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "scene/edit.h"

namespace patina {

inline constexpr std::size_t kHistoryBudget = std::size_t{512} << 20; // bytes

// The scene after each edit is kept as long as all together stay within a budget; tiles, layers and
// meshes that scenes share count once. Beyond it scenes of the past are thinned out, ever more the
// farther they lie back, and made again from the nearest one before by replaying records, which
// gives the same bits. Scenes that no record makes are never dropped. One thread.
class EditHistory {
 public:
  using Replay = std::function<Scene(const Scene& before, const Edit& edit)>;
  using Load = std::function<Scene()>;

  EditHistory(Scene start, Replay replay, std::size_t budget_bytes);

  const Scene& scene() const { return present_; }
  const Scene& start() const { return start_; }
  std::size_t undoable() const { return position_; }
  std::size_t redoable() const { return entries_.size() - position_; }
  std::vector<std::string> descriptions() const; // of all edits, oldest first
  const Edit& edit(std::size_t index) const { return entries_[index].edit; }
  // When it was made, in seconds since 1970 UTC; 0 = not known.
  std::int64_t time(std::size_t index) const { return entries_[index].time; }

  // Drops what could be redone. `record`, if any, is called when nothing after it can fail; nothing
  // changes if it throws.
  using Record = std::function<void(const Edit& edit, std::int64_t time)>;
  void append(Edit edit, Scene after, const Record& record = {});
  // For a history that was stored: `load` is called if the scene is needed and may be null where
  // the edit can be replayed. place() then sets where the history stands.
  void appendStored(Edit edit, Load load, std::int64_t time = 0);
  void place(std::size_t position, Scene present);
  // Where the scene after edit `index` is stored now; null = nowhere, where the edit can be
  // replayed.
  void store(std::size_t index, Load load) { entries_[index].load = std::move(load); }
  // Slow where a scene must be replayed. False and nothing changed if there is no such step; so too
  // if replaying throws.
  bool undo(std::size_t steps = 1);
  bool redo(std::size_t steps = 1);

  // The scene after `position` edits; replayed if it is not kept.
  Scene sceneAt(std::size_t position) const;
  // Positions whose kept scenes are worth storing: from the present back, with ever twice the cost
  // of replay (samples of strokes) between them, `cost` at first. Ascending.
  std::vector<std::size_t> landmarks(double cost) const;

  std::size_t bytes() const { return bytes_; } // of the kept scenes, shared parts once
  std::size_t scenes() const;                  // kept

 private:
  struct Entry {
    Edit edit;
    std::optional<Scene> after;
    Load load;
    std::int64_t time = 0;
  };
  static const Scene* sceneOf(const Edit& edit); // of a SceneEdit
  void truncate();
  bool goTo(std::size_t position);
  void count(const Scene& scene);
  void discount(const Scene& scene);
  void thin();

  Scene start_;
  Replay replay_;
  std::size_t budget_;
  std::vector<Entry> entries_;
  std::size_t position_ = 0;
  Scene present_;
  std::unordered_map<const void*, std::size_t> shared_; // part -> scenes that hold it
  std::size_t bytes_ = 0;
};

} // namespace patina
