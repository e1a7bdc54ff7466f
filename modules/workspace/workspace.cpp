#include "workspace/workspace.h"

#include <algorithm>
#include <memory>
#include <set>
#include <stdexcept>

#include "core/append_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_lock.h"
#include "core/partial_output.h"
#include "core/version.h"
#include "workspace/content_files.h"
#include "workspace/history_files.h"
#include "workspace/stored_objects.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

// Saving over a workspace of a newer version would lose data that this one cannot read.
void refuseNewer(const fs::path& folder) {
  const fs::path path = folder / kManifestName;
  if (!fs::exists(path)) return;
  Json json;
  try {
    json = parseJson(readFile(path), path.string());
  } catch (const FileError&) {
    return; // unreadable: saving repairs it
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

// Locks the old journal during a replacement, so that no other program appends to it.
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
                                     manifest.event, manifest.journal->checksum);
  if (journal.damaged_line != 0)
    throw FileError(path.string(), journal.damaged_line, journal.damage + kAdvice);
  if (!cause.empty()) throw FileError(path.string(), 0, cause + kAdvice);
  if (journal.torn)
    opened.notes.push_back(path.string() + ": the last record is incomplete and left out");
  for (const JournalEvent& event : journal.events)
    if (const auto* edit = std::get_if<StoredSceneEdit>(&event)) loadNamed(folder, edit->state);
  opened.journal = std::move(journal.events);
  opened.intent = std::move(journal.intent);
  opened.journal_file = path;
  opened.event = manifest.event;
}

// The states must ascend and begin with event 0.
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

// Returns the journal that starts from `first_state`: the one named in workspace.json, or the
// newest matching one if that file is damaged.
std::string journalOf(const fs::path& folder, const std::string& first_state) {
  const std::optional<Manifest> old = manifestIfReadable(folder);
  std::vector<std::string> names;
  if (old && old->journal)
    names.push_back(old->journal->file);
  else
    names = journalNames(folder);
  for (const std::string& name : names) {
    const std::string text = readFile(insidePath(folder, name));
    if (headerOf(journalLines(text)) == first_state) return name;
  }
  throw FileError(folder.string(), 0,
                  "another program has replaced this workspace; save to another folder");
}

// Replaces the old workspace by the new one in one atomic step, then removes unused files.
void commit(Manifest manifest, const std::string& journal, std::string_view journal_text,
            const fs::path& folder) {
  const JournalLines lines = journalLines(journal_text);
  manifest.journal = ManifestJournal{journal, checksumOf(lines, manifest.event)};
  if (manifest.journal->checksum.empty())
    throw std::invalid_argument("saveWorkspace: the journal has fewer events");
  // Only here: states are named by their hash, and equal edits must give equal states.
  const Json json = toJson(manifest).set("program", programDescription());
  const bool flushed = writeFileAtomically(folder / kManifestName, json.dump() + "\n");
  if (!flushed) return; // a power loss may bring the old workspace back, with all its files
  try {
    removeUnused(folder, manifest, lines);
  } catch (const std::exception&) { // such as no memory: it only takes space
  }
}

void begin(const fs::path& folder) {
  makeFolder(folder);
  // throws for a link that leads out
  for (const char* part : kStoredFolders) insidePath(folder, part);
  std::error_code code;
  const auto isMarked = [&] {
    return isWorkspace(folder) || fs::exists(folder / kUnfinishedName, code);
  };
  if (isMarked()) return;
  try {
    createFile(folder / kUnfinishedName, "");
  } catch (const FileError&) {
    if (!isMarked()) throw; // otherwise another program has begun or finished it
  }
}

// Checks the scenes that earlier edits need: without one of them the history could not be opened.
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
             std::unique_ptr<JournalWriter>* writer, const std::string& intent) {
  Manifest manifest = storeObjects(scene, folder);
  manifest.event = event;
  manifest.states = manifestStates(states, folder);
  requireStates(folder, events);
  std::string text = journalHeader(states.front().file, intent);
  std::uint64_t number = 0;
  for (const JournalEvent& item : events) text += journalLine(++number, item);
  // A new name, because the old history must not be taken for the new one.
  const std::string name = nextJournalName(folder);
  writeFileDurably(folder / name, text);
  // locked before workspace.json names it
  auto next = writer ? std::make_unique<JournalWriter>(folder / name, number) : nullptr;
  commit(std::move(manifest), name, text, folder);
  if (writer) *writer = std::move(next);
}

// Reads again if workspace.json has been replaced meanwhile, whose saving removes unused files.
template <class Read> auto readUnchanged(const fs::path& folder, const Read& read) {
  constexpr int kTries = 50;
  const auto now = [&] {
    try {
      return readFile(folder / kManifestName);
    } catch (const FileError&) {
      return std::string();
    }
  };
  for (int left = kTries;; --left) {
    const std::string before = now();
    try {
      return read();
    } catch (const FileError&) {
      if (left == 0 || now() == before) throw;
    }
  }
}

} // namespace

OpenedWorkspace openWorkspace(const fs::path& folder, bool recover) {
  if (recover) return recoverWorkspace(folder);
  return readUnchanged(folder, [&] {
    const Manifest manifest = readManifest(folder);
    OpenedWorkspace opened;
    opened.scene = loadScene(manifest, folder, (folder / kManifestName).string());
    if (manifest.journal) readHistory(folder, manifest, opened);
    return opened;
  });
}

OpenedWorkspace openHistory(const fs::path& folder) {
  return readUnchanged(folder, [&] {
    const Manifest manifest = readManifest(folder);
    OpenedWorkspace opened;
    if (manifest.journal) readHistory(folder, manifest, opened);
    return opened;
  });
}

Scene loadState(const fs::path& folder, const std::string& file) {
  const std::string name = (folder / file).string();
  return loadScene(parseManifest(loadNamed(folder, file), name), folder, name);
}

Scene loadWorkspace(const fs::path& folder) {
  return readUnchanged(folder, [&] {
    return loadScene(readManifest(folder), folder, (folder / kManifestName).string());
  });
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
                   std::unique_ptr<JournalWriter>* writer, const std::string& intent) {
  validate(scene);
  begin(folder);
  refuseNewer(folder);
  const auto lock = writer && *writer ? nullptr : lockOld(folder);
  replace(scene, event, states, journal, folder, writer, intent);
}

void saveWorkspace(const Scene& scene, const fs::path& folder, const std::string& intent) {
  validate(scene);
  NewFolder fresh(folder, kManifestName);
  begin(folder);
  {
    const FolderLock alone(folder);
    refuseNewer(folder);
    const auto lock = lockOld(folder);
    replace(scene, 0, {{0, storeState(scene, 0, folder)}}, {}, folder, nullptr, intent);
  }
  fresh.keep();
}

bool isUnfinishedWorkspace(const fs::path& path) {
  std::error_code code;
  if (isWorkspace(path)) return false;
  if (fs::is_regular_file(path / kUnfinishedName, code)) return true;
  std::size_t locks = 0, all = 0; // empty or with locks alone it had only begun
  for (fs::directory_iterator item(path, code), end; !code && item != end; item.increment(code)) {
    locks += isFolderLockFile(item->path().filename());
    ++all;
  }
  return !code && locks == all;
}

bool isWorkspace(const fs::path& path) {
  std::error_code code;
  return fs::is_regular_file(path / kManifestName, code);
}

} // namespace patina
