// Undo and redo of every edit: records, and scenes as checkpoints.
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

// Keeps the scene after each edit within a memory budget; tiles, layers and meshes that scenes
// share count once. Beyond the budget older scenes are evicted, more of them the older they are,
// and recomputed bit for bit by replaying records from the nearest earlier one. Scenes that no
// record makes are never evicted. Single-threaded.
class EditHistory {
 public:
  using Replay = std::function<Scene(const Scene& before, const Edit& edit)>;
  using Load = std::function<Scene()>;

  EditHistory(Scene start, Replay replay, std::size_t budget_bytes);

  const Scene& scene() const { return present_; }
  const Scene& start() const { return start_; }
  std::size_t undoable() const { return position_; }
  std::size_t redoable() const { return entries_.size() - position_; }
  std::vector<std::string> descriptions() const; // descriptions of all edits, oldest first
  const Edit& edit(std::size_t index) const { return entries_[index].edit; }
  // Time of the edit in seconds since 1970 UTC; 0 = unknown.
  std::int64_t time(std::size_t index) const { return entries_[index].time; }

  // Drops the redo steps. `record` is called last, after everything that can fail; nothing changes
  // if it throws.
  using Record = std::function<void(const Edit& edit, std::int64_t time)>;
  void append(Edit edit, Scene after, const Record& record = {});
  // Appends a stored edit. `load` is called if its scene is needed; it may be null if the edit can
  // be replayed. setPosition() must follow.
  void appendStored(Edit edit, Load load, std::int64_t time = 0);
  void setPosition(std::size_t position, Scene present);
  // Sets where the scene after edit `index` is stored; null = nowhere, if the edit can be replayed.
  void store(std::size_t index, Load load) { entries_[index].load = std::move(load); }
  // Slow if a scene must be replayed. Returns false if there is no such step. Nothing changes then,
  // or if replaying throws.
  bool undo(std::size_t steps = 1);
  bool redo(std::size_t steps = 1);

  // Returns the scene after `position` edits; replays it if it is not kept.
  Scene sceneAt(std::size_t position) const;
  // Positions whose scenes are worth storing, ascending. Going back from the present, the replay
  // cost (samples of strokes) between two of them doubles, from `cost`.
  std::vector<std::size_t> checkpoints(double cost) const;

  std::size_t bytes() const { return bytes_; } // kept scenes; shared parts count once
  std::size_t scenes() const;                  // number of kept scenes

 private:
  struct Entry {
    Edit edit;
    std::optional<Scene> after;
    Load load;
    std::int64_t time = 0;
  };
  static const Scene* sceneOf(const Edit& edit); // null unless a SceneEdit
  void truncate();
  bool goTo(std::size_t position);
  void addReferences(const Scene& scene);
  void removeReferences(const Scene& scene);
  void evict();

  Scene start_;
  Replay replay_;
  std::size_t budget_;
  std::vector<Entry> entries_;
  std::size_t position_ = 0;
  Scene present_;
  std::unordered_map<const void*, std::size_t> shared_; // part -> number of scenes that hold it
  std::size_t bytes_ = 0;
};

} // namespace patina
