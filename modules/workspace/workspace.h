// Stores a scene with its history as a folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "workspace/journal.h"

namespace patina {

struct StoredState {
  std::uint64_t event = 0;
  std::string file; // states/....json relative to the folder
};

struct OpenedWorkspace {
  Scene scene;             // saved after `event` journal records
  std::uint64_t event = 0; // the caller applies later records
  std::vector<JournalEvent> journal;
  std::string intent;                 // the id that the making command was given; may be empty
  std::filesystem::path journal_file; // for a JournalWriter; empty without a history
  // Ascending; the first is event 0, the scene before any edit. Empty without a history, which then
  // begins with the next saveWorkspace().
  std::vector<StoredState> states;
  std::vector<std::string> notes; // one line for each fault found and repaired
};

// Reads workspace.json (version 4, relative paths, SHA-256 of each file) with meshes/, paint/,
// states/ and journal-N.jsonl beside it, also versions 1, without history, to 3. An incomplete
// last record is left out with a note. Throws FileError naming file, line and cause: unknown
// version, wrong hash, a path that leaves the folder, a journal that is damaged, of another
// workspace or shorter than the saved one. With `recover` it keeps what is readable and notes the
// rest: of a damaged journal the records before the damage, if they include the saved ones; for a
// damaged scene the latest intact state, from which the journal continues, or the objects with
// intact files; without a readable workspace.json the journal and its states, or the newest
// readable state. Nothing on disk changes.
// While another program saves, a file that the first look at workspace.json named may be gone:
// without `recover`, and by the functions below, all is read again then.
OpenedWorkspace openWorkspace(const std::filesystem::path& folder, bool recover = false);
// Reads journal, states and notes, without the scene and its meshes and images.
OpenedWorkspace openHistory(const std::filesystem::path& folder);
Scene loadState(const std::filesystem::path& folder, const std::string& file);
// Returns the scene as saved, without its history.
Scene loadWorkspace(const std::filesystem::path& folder);

// Stores a state's files for a StoredSceneEdit or as a checkpoint; they are on disk when it
// returns. Equal files are stored once. Returns the path.
std::string storeState(const Scene& scene, std::uint64_t event,
                       const std::filesystem::path& folder);

// Atomic: the folder always holds the old or the new workspace, complete, even after a failure. The
// journal stays the one in the folder, of which the scene includes `event` records; `states` are
// those to keep. Files that nothing refers to are then removed. The rename of workspace.json is the
// last step that can fail.
void saveWorkspace(const Scene& scene, std::uint64_t event, const std::vector<StoredState>& states,
                   const std::filesystem::path& folder);
// A new workspace without history: state 0 is `scene`. It replaces the contents of the folder.
void saveWorkspace(const Scene& scene, const std::filesystem::path& folder,
                   const std::string& intent = {});

// Writes a history into another folder: `journal` replaces any journal there, in one atomic step.
// Its StoredSceneEdits name states that storeState() has put there. The caller holds a FolderLock
// since before the first storeState() (the other two functions take it themselves); otherwise
// another program's save could remove those states. `writer`: writer of the present journal, or
// null; it becomes that of the new journal, and no other program can lock either in between. After
// a throw nothing has changed. `intent`: the caller's name of the command, kept in the journal.
void saveWorkspace(const Scene& scene, std::uint64_t event, const std::vector<StoredState>& states,
                   const std::vector<JournalEvent>& journal, const std::filesystem::path& folder,
                   std::unique_ptr<JournalWriter>* writer = nullptr,
                   const std::string& intent = {});

bool isWorkspace(const std::filesystem::path& path);
// Returns true for the remains of an interrupted first save, which may be replaced: a folder that is
// empty, has only locks, or is marked as unfinished.
bool isUnfinishedWorkspace(const std::filesystem::path& path);

} // namespace patina
