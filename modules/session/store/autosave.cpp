#include "session/store/autosave.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <utility>

#include <unistd.h>

#include "core/error.h"
#include "core/file.h"
#include "core/ownership.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

constexpr const char* kLock = "lock";
constexpr const char* kWorkspace = "scene.patina";
constexpr const char* kRecording = "forces.csv";

std::filesystem::path newPlace(const std::filesystem::path& root) {
  makeFolder(root);
  if (!isOwnFolder(std::filesystem::canonical(root)))
    throw FileError(root.string(), 0,
                    "belongs to another user: set XDG_STATE_HOME to a folder of your own");
  const std::string pattern = (root / "scene-XXXXXX").string();
  std::vector<char> name(pattern.begin(), pattern.end());
  name.push_back('\0');
  if (!mkdtemp(name.data())) throw FileError(root.string(), 0, "no folder can be made in it");
  std::ofstream(std::filesystem::path(name.data()) / kLock);
  return name.data();
}

} // namespace

std::filesystem::path stateFolder() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
    return std::filesystem::path(state) / "patina";
  if (const char* home = std::getenv("HOME"); home && *home)
    return std::filesystem::path(home) / ".local" / "state" / "patina";
  return std::filesystem::temp_directory_path() / ("patina-state-" + std::to_string(::geteuid()));
}

Autosave::Autosave(const std::filesystem::path& root) : Autosave(Existing{}, newPlace(root)) {
  removes_ = true;
}

Autosave::Autosave(Existing, const std::filesystem::path& place)
    : place_(place), lock_(std::make_unique<AppendFile>(place / kLock)) {}

std::unique_ptr<Autosave> Autosave::adopt(const std::filesystem::path& place) {
  return std::unique_ptr<Autosave>(new Autosave(Existing{}, place));
}

Autosave::~Autosave() {
  if (!removes_) return;
  std::error_code code;
  std::filesystem::remove_all(place_, code);
}

std::filesystem::path Autosave::workspace() const {
  return place_ / kWorkspace;
}

std::filesystem::path Autosave::recording() const {
  return place_ / kRecording;
}

bool holdsRecording(const std::filesystem::path& place) {
  std::error_code code;
  return std::filesystem::is_regular_file(place / kRecording, code);
}

std::vector<std::filesystem::path> recoverableScenes(const std::filesystem::path& root) {
  std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> found;
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator(root, code)) {
    const bool records = holdsRecording(entry.path());
    if (!isOwnFolder(entry.path()) || (!records && !isWorkspace(entry.path() / kWorkspace)))
      continue;
    try {
      const AppendFile lock(entry.path() / kLock);
    } catch (const Error&) {
      continue; // locked by a running program
    }
    found.emplace_back(
        std::filesystem::last_write_time(entry.path() / (records ? kRecording : kWorkspace), code),
        entry.path());
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a > b; });
  std::vector<std::filesystem::path> places;
  for (auto& [time, place] : found) places.push_back(std::move(place));
  return places;
}

} // namespace patina
