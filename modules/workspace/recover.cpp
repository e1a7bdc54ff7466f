#include <algorithm>
#include <charconv>
#include <optional>

#include "core/disk_error.h"
#include "core/file.h"
#include "workspace/content_files.h"
#include "workspace/history_files.h"
#include "workspace/stored_objects.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

// Returns what `read` returns, or nullopt and adds a note. Disk errors are retried, so that one
// failure does not lose an intact history.
template <typename Read>
auto attempt(std::vector<std::string>& notes, const Read& read) -> std::optional<decltype(read())> {
  for (int again = 2;; --again) {
    try {
      return read();
    } catch (const DiskError& error) {
      if (again > 0) continue;
      notes.push_back(error.what());
    } catch (const Error& error) {
      notes.push_back(error.what());
    }
    return std::nullopt;
  }
}

// Holds journal, states and journal_file; event stays 0.
using History = OpenedWorkspace;

std::optional<History> historyIn(const fs::path& folder, const std::string& journal,
                                 const std::vector<StoredState>& states, std::uint64_t event,
                                 const std::string& checksum, std::vector<std::string>& notes) {
  return attempt(notes, [&] {
    History history;
    history.journal_file = insidePath(folder, journal);
    const std::string text = readFile(history.journal_file);
    const JournalLines lines = journalLines(text);
    const std::string first = states.empty() ? headerOf(lines) : states.front().file;
    loadNamed(folder, first); // required for replaying
    if (const std::string cause = mismatch(lines, first, event, checksum); !cause.empty())
      throw FileError(history.journal_file.string(), 0, cause);
    JournalText parsed = parseJournal(text);
    if (parsed.events.size() < event)
      throw FileError(history.journal_file.string(), parsed.damaged_line, parsed.damage);
    if (parsed.damaged_line != 0) {
      notes.push_back(FileError(history.journal_file.string(), parsed.damaged_line,
                                parsed.damage + "; this record and all later ones are left out")
                          .what());
    }
    if (parsed.torn)
      notes.push_back(history.journal_file.string() + ": the last record is incomplete");
    history.journal = std::move(parsed.events);
    history.intent = std::move(parsed.intent);
    history.states = {{0, first}};
    for (std::size_t i = 1; i < states.size(); ++i)
      if (attempt(notes, [&] { return loadNamed(folder, states[i].file); }))
        history.states.push_back(states[i]);
    return history;
  });
}

// Sets the scene from the latest intact state of a history; later journal edits are replayed.
bool startFromState(const fs::path& folder, History& history) {
  std::vector<StoredState> starts = history.states;
  for (std::size_t i = 0; i < history.journal.size(); ++i)
    if (const auto* edit = std::get_if<StoredSceneEdit>(&history.journal[i]))
      starts.push_back({i + 1, edit->state});
  std::stable_sort(starts.begin(), starts.end(),
                   [](const auto& a, const auto& b) { return a.event > b.event; });
  for (const StoredState& start : starts) {
    if (start.event > history.journal.size()) continue;
    auto scene = attempt(history.notes, [&] { return loadState(folder, start.file); });
    if (!scene) continue;
    history.scene = std::move(*scene);
    history.event = start.event;
    history.notes.push_back("the scene was restored from the state after " +
                            std::to_string(start.event) + " edits and the journal");
    return true;
  }
  return false;
}

std::optional<Scene> newestState(const fs::path& folder, std::vector<std::string>& notes) {
  std::vector<std::pair<std::uint64_t, std::string>> found;
  std::error_code code;
  for (fs::directory_iterator item(folder / "states", code), end; !code && item != end;
       item.increment(code)) {
    const std::string name = item->path().filename();
    std::uint64_t event = 0;
    std::from_chars(name.data(), name.data() + name.size(), event);
    if (isStoredName("states", name) && name.front() != '.')
      found.emplace_back(event, "states/" + name);
  }
  std::sort(found.rbegin(), found.rend());
  for (const auto& state : found) {
    auto scene = attempt(notes, [&] { return loadState(folder, state.second); });
    if (!scene) continue;
    notes.push_back("the scene is that of " + state.second);
    return scene;
  }
  return std::nullopt;
}

OpenedWorkspace fromManifest(const fs::path& folder, const Manifest& manifest) {
  const std::string name = (folder / kManifestName).string();
  std::vector<std::string> notes;
  auto scene = attempt(notes, [&] { return loadScene(manifest, folder, name); });
  std::optional<History> history;
  if (manifest.journal) {
    std::vector<StoredState> states;
    for (const ManifestState& state : manifest.states)
      states.push_back({state.event, state.file.path});
    history = historyIn(folder, manifest.journal->file, states, manifest.event,
                        manifest.journal->checksum, notes);
    if (!history) notes.push_back("the history is lost");
  }
  OpenedWorkspace opened = history ? std::move(*history) : OpenedWorkspace{};
  opened.notes = std::move(notes);
  if (scene) {
    opened.scene = std::move(*scene);
    if (history) opened.event = manifest.event;
    return opened;
  }
  if (history && startFromState(folder, opened)) return opened;
  OpenedWorkspace parts;
  parts.notes = std::move(opened.notes);
  parts.scene = loadScene(manifest, folder, name, &parts.notes);
  return parts;
}

} // namespace

OpenedWorkspace recoverWorkspace(const fs::path& folder) {
  std::vector<std::string> notes;
  if (const auto manifest = attempt(notes, [&] { return readManifest(folder); }))
    return fromManifest(folder, *manifest);
  for (const std::string& name : journalNames(folder)) {
    auto history = historyIn(folder, name, {}, 0, "", notes);
    if (!history) continue;
    history->notes = notes;
    if (startFromState(folder, *history)) return std::move(*history);
  }
  OpenedWorkspace opened;
  auto scene = newestState(folder, notes);
  if (!scene)
    throw FileError((folder / kManifestName).string(), 0,
                    "cannot be read, and neither can any state file; nothing was recovered");
  opened.scene = std::move(*scene);
  opened.notes = std::move(notes);
  return opened;
}

} // namespace patina
