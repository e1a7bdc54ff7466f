// A scene with its history as a folder that opens again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "workspace/journal.h"

namespace patina {

// A scene stored after so many events of the journal.
struct StoredState {
  std::uint64_t event = 0;
  std::string file; // states/....json relative to the folder
};

struct OpenedWorkspace {
  Scene scene;             // as saved: after `event` events
  std::uint64_t event = 0; // what the journal holds beyond it is for the reader to apply
  std::vector<JournalEvent> journal;
  std::filesystem::path journal_file; // for a JournalWriter; empty where there is no history
  // Ascending; the first is event 0, the scene before any edit. Empty without a history: it begins
  // with the next saveWorkspace().
  std::vector<StoredState> states;
  std::vector<std::string> notes; // what was found and mended, one line each
};

// workspace.json (version 3, relative paths, SHA-256 of each file): the scene as saved. Beside it
// meshes/, paint/, states/ and journal-N.jsonl. Versions 1, without history, and 2 are read too.
// A torn last record is left out with a note. Throws FileError naming file, line and cause: unknown
// version, wrong hash, a path that leaves the folder, a journal that is damaged, another
// workspace's, or shorter than what was saved. With `recover` what can be read is kept and the rest
// becomes notes: of a damaged journal the records before the damage, if the saved ones are among
// them; in place of a damaged scene the latest state that is whole, which the journal goes on from,
// or else the objects whose files are whole; without a readable workspace.json the journal and its
// states, or else the newest readable state. Nothing on disk is changed.
OpenedWorkspace openWorkspace(const std::filesystem::path& folder, bool recover = false);
// The same without the scene, whose meshes and pictures are then not read: journal, states, notes.
OpenedWorkspace openHistory(const std::filesystem::path& folder);
// Scene of a stored state.
Scene loadState(const std::filesystem::path& folder, const std::string& file);
// Only the scene as saved.
Scene loadWorkspace(const std::filesystem::path& folder);

// A state's files, for a StoredSceneEdit or as a place to begin a replay from; on disk when it
// returns. Files are named by their content, so that equal ones are stored once. Returns the path.
std::string storeState(const Scene& scene, std::uint64_t event,
                       const std::filesystem::path& folder);

// Atomic: at any moment, whatever fails, the folder holds the old workspace or the new one, whole.
// The journal is the one in the folder, `event` how much of it the scene includes; `states` those
// to keep. Files that nothing names any more are removed after that.
void saveWorkspace(const Scene& scene, std::uint64_t event, const std::vector<StoredState>& states,
                   const std::filesystem::path& folder);
// A workspace of its own, with no history: state 0 is `scene`. What was in the folder is replaced.
void saveWorkspace(const Scene& scene, const std::filesystem::path& folder);

// The same with a journal of its own that holds `journal`, in place of any that is there: what a
// history is written with into another folder. Its StoredSceneEdits name states that storeState()
// has put there. One atomic step, too. The caller holds a FolderLock from before it stores the
// first of them (the other two take it): another program's saving would remove what nothing names
// yet. `writer`: that of the journal in place, or null; it becomes the one of the new journal, and
// no other program can have either between. If this throws it is still that of the journal which
// workspace.json names, and null where that cannot be told.
void saveWorkspace(const Scene& scene, std::uint64_t event, const std::vector<StoredState>& states,
                   const std::vector<JournalEvent>& journal, const std::filesystem::path& folder,
                   std::unique_ptr<JournalWriter>* writer = nullptr);

bool isWorkspace(const std::filesystem::path& path);
// What a saver that was killed left of a new one: not to be opened, and free to be replaced.
bool isUnfinishedWorkspace(const std::filesystem::path& path);

} // namespace patina
