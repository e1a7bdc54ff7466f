#include "workspace/workspace.h"

#include <algorithm>
#include <memory>
#include <set>
#include <stdexcept>

#include "core/append_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/folder_lock.h"
#include "core/unfinished.h"
#include "core/version.h"
#include "workspace/content_files.h"
#include "workspace/history_files.h"
#include "workspace/stored_objects.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

// Saving over a workspace that a newer program wrote would lose what this one cannot read.
void refuseNewer(const fs::path& folder) {
  const fs::path path = folder / kManifestName;
  if (!fs::exists(path)) return;
  Json json;
  try {
    json = parseJson(readFile(path), path.string());
  } catch (const FileError&) {
    return; // broken: saving repairs it
  }
  const Json* version = json.isObject() ? json.find("version") : nullptr;
  if (version && version->isNumber() && version->asNumber() > kWorkspaceVersion) {
    throw FileError(path.string(), 0,
                    "was written by a newer version of this program; save to another folder");
  }
}

std::optional<Manifest> manifestIfReadable(const fs::path& folder) {
  try {
    return readManifest(folder);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

// Held while a workspace is replaced, so that another program does not go on writing its history.
std::unique_ptr<AppendFile> lockOld(const fs::path& folder) {
  const std::optional<Manifest> old = manifestIfReadable(folder);
  std::error_code code;
  if (!old || !old->journal || !fs::exists(folder / old->journal->file, code)) return nullptr;
  return std::make_unique<AppendFile>(insidePath(folder, old->journal->file));
}

void readHistory(const fs::path& folder, const Manifest& manifest, OpenedWorkspace& opened) {
  for (const ManifestState& state : manifest.states) {
    loadContent(folder, state.file);
    opened.states.push_back({state.event, state.file.path});
  }
  const fs::path path = insidePath(folder, manifest.journal->file);
  if (!fs::exists(path)) throw FileError(path.string(), 0, std::string("is missing") + kAdvice);
  const std::string text = readFile(path);
  JournalText journal = parseJournal(text);
  const std::string cause = mismatch(journalLines(text), manifest.states.front().file.path,
                                     manifest.event, manifest.journal->check);
  if (journal.damaged_line != 0)
    throw FileError(path.string(), journal.damaged_line, journal.damage + kAdvice);
  if (!cause.empty()) throw FileError(path.string(), 0, cause + kAdvice);
  if (journal.torn)
    opened.notes.push_back(path.string() +
                           ": the last record was not written whole and is left out");
  for (const JournalEvent& event : journal.events)
    if (const auto* edit = std::get_if<StoredSceneEdit>(&event)) loadNamed(folder, edit->state);
  opened.journal = std::move(journal.events);
  opened.journal_file = path;
  opened.event = manifest.event;
}

// states.front() is event 0 and they ascend.
std::vector<ManifestState> manifestStates(const std::vector<StoredState>& states,
                                          const fs::path& folder) {
  std::vector<ManifestState> stored;
  for (const StoredState& state : states) {
    const bool ascends = stored.empty() ? state.event == 0 : state.event > stored.back().event;
    if (!ascends) throw std::invalid_argument("saveWorkspace: states must ascend from event 0");
    ManifestState& item = stored.emplace_back();
    item.event = state.event;
    loadNamed(folder, state.file, &item.file);
  }
  if (stored.empty()) throw std::invalid_argument("saveWorkspace: no state 0");
  return stored;
}

// The journal that goes on from `first_state`: the one that workspace.json names, or, where that is
// broken, the newest that fits.
std::string journalOf(const fs::path& folder, const std::string& first_state) {
  const std::optional<Manifest> old = manifestIfReadable(folder);
  std::vector<std::string> names;
  if (old && old->journal)
    names.push_back(old->journal->file);
  else
    names = journalNames(folder);
  for (const std::string& name : names) {
    const std::string text = readFile(insidePath(folder, name));
    if (headingOf(journalLines(text)) == first_state) return name;
  }
  throw FileError(folder.string(), 0,
                  "another program has replaced this workspace; save to another folder");
}

// The one moment at which the old workspace becomes the new one, and what follows.
void commit(Manifest manifest, const std::string& journal, std::string_view journal_text,
            const fs::path& folder) {
  const JournalLines lines = journalLines(journal_text);
  manifest.journal = ManifestJournal{journal, checkOf(lines, manifest.event)};
  if (manifest.journal->check.empty())
    throw std::invalid_argument("saveWorkspace: the journal has fewer events");
  // Not in a state, whose name holds its hash: the same edits give the same states.
  const Json json = toJson(manifest).set("program", programDescription());
  writeFileAtomically(folder / kManifestName, json.dump() + "\n");
  removeUnused(folder, manifest, lines);
}

// The folder is there from here on, and says that it is no workspace yet.
void begin(const fs::path& folder) {
  makeFolder(folder);
  for (const char* part : kStoredFolders) insidePath(folder, part); // nothing through a link
  std::error_code code;
  const auto isMarked = [&] {
    return isWorkspace(folder) || fs::exists(folder / kUnfinishedName, code);
  };
  if (isMarked()) return;
  try {
    createFile(folder / kUnfinishedName, "");
  } catch (const FileError&) {
    if (!isMarked()) throw; // else another program has begun it, too, or finished it
  }
}

// Of scenes that were stored before: a history without one of them could not be opened.
void requireStates(const fs::path& folder, const std::vector<JournalEvent>& events) {
  std::set<std::string> read;
  for (const JournalEvent& event : events) {
    const auto* edit = std::get_if<StoredSceneEdit>(&event);
    if (!edit || !read.insert(edit->state).second) continue;
    const Manifest state = parseManifest(loadNamed(folder, edit->state), edit->state);
    for (const ContentFile& file : filesOf(state))
      if (read.insert(file.path).second) loadContent(folder, file);
  }
}

void replace(const Scene& scene, std::uint64_t event, const std::vector<StoredState>& states,
             const std::vector<JournalEvent>& events, const fs::path& folder,
             std::unique_ptr<JournalWriter>* writer = nullptr) {
  Manifest manifest = storeObjects(scene, folder);
  manifest.event = event;
  manifest.states = manifestStates(states, folder);
  requireStates(folder, events);
  std::string text = journalHeading(states.front().file);
  std::uint64_t number = 0;
  for (const JournalEvent& item : events) text += journalLine(++number, item);
  // Under a name of its own: the old history must not be taken for the new one's.
  const std::string name = nextJournalName(folder);
  writeFileAtomically(folder / name, text);
  if (!writer) return commit(std::move(manifest), name, text, folder);
  auto next = std::make_unique<JournalWriter>(folder / name, number); // before anyone knows of it
  try {
    commit(std::move(manifest), name, text, folder);
  } catch (...) {
    // It may have been put in place, and only the folder not flushed.
    const std::optional<Manifest> now = manifestIfReadable(folder);
    if (!now)
      writer->reset();
    else if (now->journal && now->journal->file == name)
      *writer = std::move(next);
    throw;
  }
  *writer = std::move(next);
}

} // namespace

OpenedWorkspace openWorkspace(const fs::path& folder, bool recover) {
  if (recover) return recoverWorkspace(folder);
  const Manifest manifest = readManifest(folder);
  OpenedWorkspace opened;
  opened.scene = loadScene(manifest, folder, (folder / kManifestName).string());
  if (manifest.journal) readHistory(folder, manifest, opened);
  return opened;
}

OpenedWorkspace openHistory(const fs::path& folder) {
  const Manifest manifest = readManifest(folder);
  OpenedWorkspace opened;
  if (manifest.journal) readHistory(folder, manifest, opened);
  return opened;
}

Scene loadState(const fs::path& folder, const std::string& file) {
  const std::string name = (folder / file).string();
  return loadScene(parseManifest(loadNamed(folder, file), name), folder, name);
}

Scene loadWorkspace(const fs::path& folder) {
  return loadScene(readManifest(folder), folder, (folder / kManifestName).string());
}

std::string storeState(const Scene& scene, std::uint64_t event, const fs::path& folder) {
  validate(scene);
  begin(folder);
  Manifest manifest = storeObjects(scene, folder);
  manifest.event = event;
  return storeContent(folder, "states/" + std::to_string(event), ".json",
                      toJson(manifest).dump() + "\n")
      .path;
}

void saveWorkspace(const Scene& scene, std::uint64_t event, const std::vector<StoredState>& states,
                   const fs::path& folder) {
  validate(scene);
  const FolderLock alone(folder);
  refuseNewer(folder);
  Manifest manifest = storeObjects(scene, folder);
  manifest.event = event;
  manifest.states = manifestStates(states, folder);
  const std::string journal = journalOf(folder, states.front().file);
  const std::string text = readFile(insidePath(folder, journal));
  commit(std::move(manifest), journal, text, folder);
}

void saveWorkspace(const Scene& scene, std::uint64_t event, const std::vector<StoredState>& states,
                   const std::vector<JournalEvent>& journal, const fs::path& folder,
                   std::unique_ptr<JournalWriter>* writer) {
  validate(scene);
  begin(folder);
  refuseNewer(folder);
  const auto lock = writer && *writer ? nullptr : lockOld(folder);
  replace(scene, event, states, journal, folder, writer);
}

void saveWorkspace(const Scene& scene, const fs::path& folder) {
  validate(scene);
  NewFolder fresh(folder, kManifestName);
  begin(folder);
  {
    const FolderLock alone(folder);
    refuseNewer(folder);
    const auto lock = lockOld(folder);
    replace(scene, 0, {{0, storeState(scene, 0, folder)}}, {}, folder);
  }
  fresh.keep();
}

bool isUnfinishedWorkspace(const fs::path& path) {
  std::error_code code;
  return !isWorkspace(path) && fs::is_regular_file(path / kUnfinishedName, code);
}

bool isWorkspace(const fs::path& path) {
  std::error_code code;
  return fs::is_regular_file(path / kManifestName, code);
}

} // namespace patina
