#include "session/store/workspace_storage.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/file_lock.h"
#include "core/ownership.h"
#include "core/partial_output.h"
#include "session/store/journal_fold.h"
#include "workspace/manifest.h"

namespace patina {
namespace {

// Initial replay cost between two stored scenes, in samples of strokes: about a second.
constexpr double kCheckpointCost = 500;

// Returns true if the scene after `event` is still the one at that position of the folded journal:
// all its steps must be older than the event.
bool stillThere(const FoldedJournal& fold, std::uint64_t event, std::size_t position) {
  if (position > fold.steps.size()) return false;
  for (std::size_t i = 0; i < position; ++i)
    if (fold.steps[i].number > event) return false;
  return true;
}

Edit editOf(const JournalEvent& event) {
  if (const auto* stroke = std::get_if<Stroke>(&event)) return *stroke;
  if (const auto* values = std::get_if<ValueEdit>(&event)) return *values;
  return SceneEdit{std::get<StoredSceneEdit>(event).what, nullptr};
}

} // namespace

std::set<std::string> intentsOf(const OpenedWorkspace& opened) {
  std::set<std::string> intents{opened.intent};
  for (const JournalEvent& event : opened.journal) intents.insert(event.intent);
  intents.erase("");
  return intents;
}

void requireWorkspacePlace(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  if (!pathExists(folder) || isWorkspace(folder)) return;
  if (!isUnfinishedWorkspace(folder))
    throw FileError(folder.string(), 0, "exists and is not a workspace; choose another folder");
}

WorkspaceStorage::WorkspaceStorage(std::filesystem::path folder) : folder_(std::move(folder)) {}

EditHistory::Load WorkspaceStorage::loader(const std::string& state) const {
  return [folder = folder_, state] { return loadState(folder, state); };
}

// Binds only edits that can be replayed; saving removes the files of all other states.
void WorkspaceStorage::bindStates(EditHistory& history) const {
  for (std::size_t i = 0; i + 1 < event_of_.size(); ++i) {
    if (std::holds_alternative<SceneEdit>(history.edit(i))) continue;
    const auto stored = std::find_if(states_.begin(), states_.end(), [&](const StoredState& s) {
      return s.event == event_of_[i + 1];
    });
    history.store(i, stored == states_.end() ? EditHistory::Load() : loader(stored->file));
  }
}

WorkspaceStorage::Opened WorkspaceStorage::open(const std::filesystem::path& folder,
                                                EditHistory::Replay replay, std::size_t budget,
                                                bool keep_journal, bool recover) {
  if (keep_journal) refuseForeignLink(folder, folder);
  OpenedWorkspace found = openWorkspace(folder, recover);
  const bool has_history = !found.states.empty();
  Opened opened = openedFrom(folder, found, std::move(replay), budget);
  if (!keep_journal) {
    opened.storage = nullptr;
  } else if (has_history) {
    opened.storage->journal_ =
        std::make_unique<JournalWriter>(found.journal_file, found.journal.size());
  } else if (recover) { // the unreadable history may still be repaired by hand
    opened.storage = nullptr;
    opened.notes.push_back(folder.string() + ": stays as it is; save the scene to another folder");
  }
  return opened;
}

WorkspaceStorage::Opened WorkspaceStorage::openedFrom(const std::filesystem::path& folder,
                                                      OpenedWorkspace& found,
                                                      EditHistory::Replay replay,
                                                      std::size_t budget) {
  Opened opened;
  opened.notes = std::move(found.notes);
  opened.events = found.journal.size();
  opened.intents = intentsOf(found);
  const FoldedJournal fold = folded(found.journal, found.journal_file.string());
  std::map<std::size_t, std::string> state_at; // key: position
  for (const StoredState& state : found.states) {
    if (state.event >= fold.position_at.size()) continue;
    const std::size_t position = fold.position_at[state.event];
    if (stillThere(fold, state.event, position)) state_at[position] = state.file;
  }
  opened.storage.reset(new WorkspaceStorage(folder));
  WorkspaceStorage& place = *opened.storage;
  const auto first = state_at.find(0);
  Scene start = first == state_at.end() ? found.scene : loadState(folder, first->second);
  opened.history = std::make_unique<EditHistory>(std::move(start), std::move(replay), budget);
  for (std::size_t i = 0; i < fold.steps.size(); ++i) {
    EditHistory::Load load;
    if (const auto* scene = std::get_if<StoredSceneEdit>(fold.steps[i].event))
      load = place.loader(scene->state);
    else if (const auto state = state_at.find(i + 1); state != state_at.end())
      load = place.loader(state->second);
    opened.history->appendStored(editOf(*fold.steps[i].event), std::move(load),
                                 fold.steps[i].event->time);
  }
  // The saved scene, if it is still in the history; later journal edits are replayed.
  const std::uint64_t saved_event = std::min<std::uint64_t>(found.event, found.journal.size());
  const std::size_t saved = fold.position_at[saved_event];
  const bool kept = stillThere(fold, saved_event, saved);
  if (kept) opened.history->setPosition(saved, found.scene), opened.saved_at = saved;
  // All later edits may have been undone.
  opened.unsaved = saved_event < found.journal.size() && !(kept && fold.position == saved);
  if (opened.unsaved || opened.history->undoable() != fold.position)
    opened.history->setPosition(fold.position, opened.history->sceneAt(fold.position));
  if (found.states.empty()) { // a version without history, whose history begins with the first edit
    place.without_history_ = opened.history.get();
    return opened;
  }
  place.states_ = std::move(found.states);
  place.event_of_.push_back(0);
  for (const FoldedJournal::Step& step : fold.steps) place.event_of_.push_back(step.number);
  return opened;
}

std::unique_ptr<WorkspaceStorage> WorkspaceStorage::create(const std::filesystem::path& folder,
                                                           EditHistory& history,
                                                           const std::string& intent) {
  NewFolder fresh(folder, kManifestName);
  makeFolder(folder);
  const FolderLock alone(folder);
  requireWorkspacePlace(folder);
  auto storage = write(folder, history, intent);
  fresh.keep();
  return storage;
}

std::unique_ptr<WorkspaceStorage> WorkspaceStorage::overwrite(const std::filesystem::path& folder,
                                                              EditHistory& history,
                                                              const std::string& intent) {
  NewFolder fresh(folder, kManifestName);
  makeFolder(folder);
  const FolderLock alone(folder);
  auto storage = write(folder, history, intent);
  fresh.keep();
  return storage;
}

std::unique_ptr<WorkspaceStorage> WorkspaceStorage::write(const std::filesystem::path& folder,
                                                          EditHistory& history,
                                                          const std::string& intent) {
  auto storage = std::unique_ptr<WorkspaceStorage>(new WorkspaceStorage(folder));
  std::map<std::size_t, std::string> scenes; // files of the SceneEdits, by index
  std::vector<JournalEvent> journal;
  storage->states_.push_back({0, storeState(history.start(), 0, folder)});
  storage->event_of_.push_back(0);
  const std::size_t count = history.undoable() + history.redoable();
  for (std::size_t i = 0; i < count; ++i) {
    const Edit& edit = history.edit(i);
    const std::uint64_t event = i + 1;
    if (const auto* stroke = std::get_if<Stroke>(&edit))
      journal.emplace_back(*stroke);
    else if (const auto* values = std::get_if<ValueEdit>(&edit))
      journal.emplace_back(*values);
    else
      journal.emplace_back(
          StoredSceneEdit{std::get<SceneEdit>(edit).what,
                          scenes[i] = storeState(history.sceneAt(event), event, folder)});
    journal.back().time = history.time(i);
    storage->event_of_.push_back(event);
  }
  for (const std::size_t position : history.checkpoints(kCheckpointCost))
    storage->states_.push_back({position, storeState(history.sceneAt(position), position, folder)});
  if (history.redoable() > 0) journal.emplace_back(UndoEvent{static_cast<int>(history.redoable())});
  saveWorkspace(history.scene(), journal.size(), storage->states_, journal, folder,
                &storage->journal_, intent);
  for (const auto& [index, state] : scenes) history.store(index, storage->loader(state));
  storage->bindStates(history);
  return storage;
}

void WorkspaceStorage::beginHistory() {
  if (journal_ || !without_history_) return;
  const FolderLock alone(folder_);
  if (!openWorkspace(folder_).states.empty())
    throw FileError(folder_.string(), 0, "another program has begun to edit it: open it again");
  const auto begun = write(folder_, *std::exchange(without_history_, nullptr), "");
  journal_ = std::move(begun->journal_);
  event_of_ = std::move(begun->event_of_);
  states_ = std::move(begun->states_);
}

JournalWriter& WorkspaceStorage::journal() const {
  if (!journal_)
    throw FileError(folder_.string(), 0,
                    "its history cannot be written any more: save to another folder");
  return *journal_;
}

std::uint64_t WorkspaceStorage::events() const {
  return journal().events() + held_.size();
}

void WorkspaceStorage::record(JournalEvent event) {
  event.intent = intent_;
  if (holds_)
    held_.push_back(std::move(event));
  else
    journal().append(std::move(event));
}

void WorkspaceStorage::commit() {
  if (!held_.empty()) journal().append(std::exchange(held_, {}));
}

void WorkspaceStorage::recordEdit(const Edit& edit, std::size_t position_after, std::int64_t time) {
  beginHistory();
  // Reserves memory first: after the write nothing may fail.
  if (event_of_.capacity() <= position_after) event_of_.reserve(2 * position_after + 1);
  const auto append = [&](JournalEvent event) {
    event.time = time;
    record(std::move(event));
  };
  if (const auto* stroke = std::get_if<Stroke>(&edit)) {
    append(*stroke);
  } else if (const auto* values = std::get_if<ValueEdit>(&edit)) {
    append(*values);
  } else {
    const SceneEdit& whole = std::get<SceneEdit>(edit);
    append(StoredSceneEdit{whole.what, storeState(*whole.scene, events() + 1, folder_)});
  }
  event_of_.resize(position_after);
  event_of_.push_back(events());
}

void WorkspaceStorage::recordUndo(std::size_t steps) {
  record(UndoEvent{static_cast<int>(steps)});
}

void WorkspaceStorage::recordRedo(std::size_t steps) {
  record(RedoEvent{static_cast<int>(steps)});
}

void WorkspaceStorage::save(EditHistory& history) {
  beginHistory();
  const std::uint64_t events = journal().events();
  std::vector<StoredState> states;
  if (!states_.empty() && states_.front().event == 0) states.push_back(states_.front());
  for (const std::size_t position : history.checkpoints(kCheckpointCost)) {
    const std::uint64_t event = event_of_[position];
    const auto stored = std::find_if(states_.begin(), states_.end(),
                                     [&](const StoredState& s) { return s.event == event; });
    states.push_back(
        stored != states_.end()
            ? *stored
            : StoredState{event, storeState(history.sceneAt(position), event, folder_)});
  }
  saveWorkspace(history.scene(), events, states, folder_);
  states_ = std::move(states);
  bindStates(history);
}

WorkspaceStorage::Opened WorkspaceStorage::revert(EditHistory::Replay replay, std::size_t budget) {
  const FolderLock alone(folder_);
  OpenedWorkspace found = openWorkspace(folder_);
  if (found.journal.size() != (journal_ ? journal_->events() : 0))
    throw FileError(folder_.string(), 0, "another program has edited it: open it again");
  const bool more = found.event < found.journal.size();
  found.journal.erase(found.journal.begin() + static_cast<std::ptrdiff_t>(found.event),
                      found.journal.end());
  // Everything that may fail comes before the write.
  Opened saved = openedFrom(folder_, found, std::move(replay), budget);
  if (more)
    saveWorkspace(found.scene, found.event, saved.storage->states_, found.journal, folder_,
                  &journal_, found.intent);
  saved.storage->journal_ = std::move(journal_);
  return saved;
}

} // namespace patina
