// An editor's tie to its folder: the journal it writes, the states it keeps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "session/edit/edit_history.h"
#include "workspace/workspace.h"

namespace patina {

// FileError unless a workspace may be written there: nothing, an empty folder or a workspace.
void requireWorkspacePlace(const std::filesystem::path& folder);

// Belongs to the editor's thread. Every call returns when what it did is on disk; on failure it
// throws FileError and has done nothing.
class WorkspaceLink {
 public:
  // What openWorkspace() found, folded into a history; edits beyond the saved scene are replayed.
  // `keep_journal`: lock the journal and write to it, else only read; so, too, where `recover`
  // found no history, which writing would replace.
  struct Opened {
    std::unique_ptr<EditHistory> history;
    std::unique_ptr<WorkspaceLink> link; // null unless keep_journal
    std::vector<std::string> notes;
    std::uint64_t events = 0;            // of the journal, undos too: they only ever become more
    bool unsaved = false;                // the journal holds more than the saved scene
    std::optional<std::size_t> saved_at; // position of the saved scene; absent: not in the history
  };
  static Opened open(const std::filesystem::path& folder, EditHistory::Replay replay,
                     std::size_t budget, bool keep_journal, bool recover);
  // Writes the whole history into another folder, taking the place of a workspace there, and ties
  // to it: scenes of the past are loaded from there from now on. requireWorkspacePlace() first.
  static std::unique_ptr<WorkspaceLink> create(const std::filesystem::path& folder,
                                               EditHistory& history);
  // The same over whatever stands there: what is left of a damaged workspace.
  static std::unique_ptr<WorkspaceLink> createOver(const std::filesystem::path& folder,
                                                   EditHistory& history);

  const std::filesystem::path& folder() const { return folder_; }
  // A workspace of a version without history stays as it is until the first of these.
  void recordEdit(const Edit& edit, std::size_t position_after, std::int64_t time);
  void recordUndo(std::size_t steps);
  void recordRedo(std::size_t steps);
  void save(EditHistory& history); // states that are dropped are not loaded any more
  // The folder is as it was last saved, its history too: a journal of its own begins with what that
  // holds. What is returned takes the place of this, which can record nothing any more; the journal
  // is locked throughout.
  Opened revert(EditHistory::Replay replay, std::size_t budget);

 private:
  explicit WorkspaceLink(std::filesystem::path folder);
  // Of what was found there, whose states it takes; the link has no journal yet.
  static Opened openedFrom(const std::filesystem::path& folder, OpenedWorkspace& found,
                           EditHistory::Replay replay, std::size_t budget);
  // The folder is there and locked.
  static std::unique_ptr<WorkspaceLink> write(const std::filesystem::path& folder,
                                              EditHistory& history);
  void beginHistory();
  JournalWriter& journal() const; // FileError if it has none
  EditHistory::Load loader(const std::string& state) const;
  void tieStates(EditHistory& history) const;

  std::filesystem::path folder_;
  // Null while there is no history on disk, or if it is not known which journal is in place.
  std::unique_ptr<JournalWriter> journal_;
  EditHistory* without_history_ = nullptr; // whose beginning that will be
  std::vector<std::uint64_t> event_of_; // by position: the event after which the scene is that one
  std::vector<StoredState> states_;     // on disk
};

} // namespace patina
