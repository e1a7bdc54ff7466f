#include "workspace/history_files.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "core/error.h"
#include "core/file.h"
#include "workspace/content_files.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kJournalStart = "journal-";
constexpr std::string_view kJournalEnd = ".jsonl";

// Returns 0 for a name of another form.
std::uint64_t journalNumber(std::string_view name) {
  if (!name.starts_with(kJournalStart) || !name.ends_with(kJournalEnd)) return 0;
  name.remove_prefix(kJournalStart.size());
  name.remove_suffix(kJournalEnd.size());
  std::uint64_t number = 0;
  const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc() && stop == name.data() + name.size() ? number : 0;
}

std::vector<std::pair<std::uint64_t, std::string>> journals(const fs::path& folder) {
  std::vector<std::pair<std::uint64_t, std::string>> found;
  std::error_code code;
  for (fs::directory_iterator item(folder, code), end; !code && item != end; item.increment(code)) {
    const std::string name = item->path().filename();
    if (const std::uint64_t number = journalNumber(name)) found.emplace_back(number, name);
  }
  std::sort(found.rbegin(), found.rend());
  return found;
}

const JournalRecord* recordAt(const JournalLines& lines, std::uint64_t event) {
  if (lines.records.empty() || event < lines.records.front().number) return nullptr;
  const std::uint64_t index = event - lines.records.front().number;
  return index < lines.records.size() ? &lines.records[index] : nullptr;
}

// Files of one folder of the workspace; "" = the workspace folder.
void removeUnusedIn(const fs::path& folder, const std::string& part,
                    const std::set<std::string>& used) {
  std::vector<fs::path> unused;
  std::error_code code;
  // A link leads to files outside the workspace.
  if (!part.empty() && fs::is_symlink(folder / part, code)) return;
  for (fs::directory_iterator item(folder / part, code), end; !code && item != end;
       item.increment(code)) {
    const std::string name = item->path().filename();
    const std::string relative = part.empty() ? name : part + "/" + name;
    if (isStoredName(part, name) && !used.contains(relative)) unused.push_back(item->path());
  }
  for (const fs::path& path : unused) fs::remove(path, code);
}

} // namespace

std::vector<std::string> journalNames(const fs::path& folder) {
  std::vector<std::string> names;
  for (auto& [number, name] : journals(folder)) names.push_back(std::move(name));
  return names;
}

std::string nextJournalName(const fs::path& folder) {
  const auto found = journals(folder);
  const std::uint64_t number = found.empty() ? 1 : found.front().first + 1;
  return std::string(kJournalStart) + std::to_string(number) + std::string(kJournalEnd);
}

std::string checksumOf(const JournalLines& lines, std::uint64_t event) {
  const JournalRecord* record = recordAt(lines, event);
  return record ? std::string(record->checksum) : std::string();
}

std::uint64_t countOf(const JournalLines& lines) {
  return lines.records.empty() ? 0 : lines.records.back().number;
}

std::string headerOf(const JournalLines& lines) {
  const JournalRecord* header = recordAt(lines, 0);
  if (!header) return "";
  try {
    return parseJson(header->text, "heading").at("from").asString();
  } catch (const Error&) {
    return "";
  }
}

std::vector<StoredState> statesIn(const JournalLines& lines) {
  std::vector<StoredState> states;
  for (const JournalRecord& record : lines.records) {
    // Most records are long strokes; this skips parsing them.
    if (record.text.substr(0, 64).find(",\"scene\":") == std::string_view::npos) continue;
    const Json json = parseJson(record.text, "record");
    if (const Json* scene = json.find("scene"))
      states.push_back({record.number, scene->at("state").asString()});
  }
  return states;
}

std::string mismatch(const JournalLines& lines, const std::string& first_state, std::uint64_t event,
                     const std::string& checksum) {
  if (lines.records.empty()) return "holds nothing";
  if (headerOf(lines) != first_state) return "is the journal of another workspace";
  if (countOf(lines) < event) {
    return "holds " + std::to_string(countOf(lines)) + " of the " + std::to_string(event) +
           " edits that were saved";
  }
  if (!checksum.empty() && checksumOf(lines, event) != checksum)
    return "is the journal of another workspace";
  return "";
}

void removeUnused(const fs::path& folder, const Manifest& manifest, const JournalLines& lines) {
  std::set<std::string> used{kManifestName, manifest.journal->file};
  const auto use = [&](const Manifest& scene) {
    for (const ContentFile& file : filesOf(scene)) used.insert(file.path);
  };
  try {
    use(manifest);
    std::vector<StoredState> states = statesIn(lines);
    for (const ManifestState& state : manifest.states)
      states.push_back({state.event, state.file.path});
    for (const StoredState& state : states) {
      if (!used.insert(state.file).second) continue;
      use(parseManifest(loadNamed(folder, state.file), state.file));
    }
  } catch (const Error&) {
    return; // an unreadable state may need any file
  }
  removeUnusedIn(folder, "", used);
  for (const char* part : kStoredFolders) removeUnusedIn(folder, part, used);
}

} // namespace patina
