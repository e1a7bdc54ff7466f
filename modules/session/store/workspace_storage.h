// Storage of an editor's workspace: its journal and its stored states.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "session/store/edit_history.h"
#include "workspace/workspace.h"

namespace patina {

// Throws FileError unless the path is free, an empty folder or a workspace.
void requireWorkspacePlace(const std::filesystem::path& folder);

// Names that callers gave to the commands whose work is in the workspace and its journal.
std::set<std::string> intentsOf(const OpenedWorkspace& opened);

// Used on the editor's thread. Every call returns after its data are on disk; a call that fails
// throws FileError and changes nothing.
class WorkspaceStorage {
 public:
  // Result of openWorkspace(), folded into a history; edits after the saved scene are replayed.
  // `keep_journal`: lock the journal for writing, otherwise only read. It is only read, too, if
  // `recover` found no history, which writing would replace.
  struct Opened {
    std::unique_ptr<EditHistory> history;
    std::unique_ptr<WorkspaceStorage> storage; // null unless keep_journal
    std::vector<std::string> notes;
    std::uint64_t events = 0;            // number of journal records with undos; it never decreases
    bool unsaved = false;                // the journal has edits after the saved scene
    std::optional<std::size_t> saved_at; // position of the saved scene; absent: not in the history
    std::set<std::string> intents;       // intentsOf() what was opened
  };
  static Opened open(const std::filesystem::path& folder, EditHistory::Replay replay,
                     std::size_t budget, bool keep_journal, bool recover);
  // Writes the whole history into another folder, replaces a workspace there, and loads earlier
  // scenes from there from now on. Call requireWorkspacePlace() first.
  // `intent` is the caller's name of the command.
  static std::unique_ptr<WorkspaceStorage>
  create(const std::filesystem::path& folder, EditHistory& history, const std::string& intent = {});
  // The same, but replaces anything there, such as a damaged workspace.
  static std::unique_ptr<WorkspaceStorage> overwrite(const std::filesystem::path& folder,
                                                     EditHistory& history,
                                                     const std::string& intent = {});

  const std::filesystem::path& folder() const { return folder_; }
  void setIntent(std::string intent) { intent_ = std::move(intent); } // the next records have it
  // Holds records back until commit(), which writes all of them in one act, or none.
  void hold() { holds_ = true; }
  void commit();
  // A workspace from a version without history is unchanged until the first of these calls.
  void recordEdit(const Edit& edit, std::size_t position_after, std::int64_t time);
  void recordUndo(std::size_t steps);
  void recordRedo(std::size_t steps);
  void save(EditHistory& history); // dropped states can no longer be loaded
  // Returns the folder to its last save, with its history; the new journal starts with that. The
  // result replaces this object, which can record nothing any more. The journal stays locked.
  Opened revert(EditHistory::Replay replay, std::size_t budget);

 private:
  explicit WorkspaceStorage(std::filesystem::path folder);
  // Builds the history from `found` and takes its states; the result has no journal yet.
  static Opened openedFrom(const std::filesystem::path& folder, OpenedWorkspace& found,
                           EditHistory::Replay replay, std::size_t budget);
  // The folder exists and is locked.
  static std::unique_ptr<WorkspaceStorage> write(const std::filesystem::path& folder,
                                                 EditHistory& history, const std::string& intent);
  void record(JournalEvent event);
  std::uint64_t events() const; // with those held back
  void beginHistory();
  JournalWriter& journal() const; // throws FileError if there is none
  EditHistory::Load loader(const std::string& state) const;
  void bindStates(EditHistory& history) const;

  std::filesystem::path folder_;
  // Null while there is no history on disk.
  std::unique_ptr<JournalWriter> journal_;
  EditHistory* without_history_ = nullptr; // to be written as the first history
  std::vector<std::uint64_t> event_of_;    // per position, the journal event that led to it
  std::vector<StoredState> states_;        // states on disk
  std::string intent_;
  bool holds_ = false;
  std::vector<JournalEvent> held_;
};

} // namespace patina
