#include "session/store/autosave.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <utility>

#include <unistd.h>

#include "core/error.h"
#include "core/file.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

constexpr const char* kLock = "lock";
constexpr const char* kWorkspace = "scene.patina";

std::filesystem::path newPlace(const std::filesystem::path& root) {
  makeFolder(root);
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
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home && *home ? home : "/tmp") / ".local" / "state" / "patina";
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

std::vector<std::filesystem::path> leftBehind(const std::filesystem::path& root) {
  std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> found;
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator(root, code)) {
    if (!isWorkspace(entry.path() / kWorkspace)) continue;
    try {
      const AppendFile lock(entry.path() / kLock);
    } catch (const Error&) {
      continue; // of a program that lives
    }
    found.emplace_back(std::filesystem::last_write_time(entry.path() / kWorkspace, code),
                       entry.path());
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a > b; });
  std::vector<std::filesystem::path> places;
  for (auto& [time, place] : found) places.push_back(std::move(place));
  return places;
}

} // namespace patina
