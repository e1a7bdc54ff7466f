#include "core/unfinished.h"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <mutex>
#include <unistd.h>
#include <utility>

#include "core/descriptor.h"
#include "core/disk_error.h"

namespace patina {
namespace {

// Names of files are the whole process's, as the files are.
struct Known {
  std::mutex guard;
  std::list<Unfinished::Place> places;
  bool any_finished = false;
};
Known& known() {
  static Known* const all = new Known; // never destroyed: the last to use it is exit itself
  return *all;
}

// Set aside first: whoever is about to finish it either has, which is seen then, or cannot.
void removeUnlessWhole(const Unfinished::Place& place) noexcept {
  namespace fs = std::filesystem;
  const auto isWhole = [&](const fs::path& folder) {
    return !place.whole.empty() && ::access((folder / place.whole).c_str(), F_OK) == 0;
  };
  if (isWhole(place.path)) return;
  fs::path aside = place.path;
  std::error_code ignored;
  if (!place.whole.empty() || fs::is_directory(place.path, ignored)) { // others may write there yet
    aside = place.path.parent_path() /
            ("." + place.path.filename().string() + "." + std::to_string(::getpid()) + ".tmp");
    if (::rename(place.path.c_str(), aside.c_str()) != 0) return;
    if (isWhole(aside) && ::rename(aside.c_str(), place.path.c_str()) == 0) return;
  }
  fs::remove_all(aside, ignored);
}

} // namespace

Unfinished::Unfinished(const std::filesystem::path& path, const std::string& whole) : held_(true) {
  const std::lock_guard hold(known().guard);
  auto& places = known().places;
  place_ = places.insert(places.end(), {std::filesystem::absolute(path), whole});
}

Unfinished::Unfinished(Unfinished&& other) noexcept
    : place_(other.place_), held_(std::exchange(other.held_, false)) {}

Unfinished& Unfinished::operator=(Unfinished&& other) noexcept {
  std::swap(place_, other.place_);
  std::swap(held_, other.held_);
  return *this;
}

void Unfinished::done() noexcept {
  if (!std::exchange(held_, false)) return;
  const std::lock_guard hold(known().guard);
  known().places.erase(place_);
}

int Unfinished::finish(const std::function<int()>& last) {
  const std::lock_guard hold(known().guard);
  const int result = last();
  if (result != 0 || !std::exchange(held_, false)) return result;
  const std::string path = place_->path.string();
  known().places.erase(place_);
  known().any_finished |=
      std::none_of(known().places.begin(), known().places.end(),
                   [&](const Place& place) { return path.starts_with(place.path.string() + "/"); });
  return result;
}

NewFolder::NewFolder(const std::filesystem::path& folder, const std::string& whole)
    : place_{std::filesystem::absolute(folder), whole} {
  if (!place_.path.has_filename()) place_.path = place_.path.parent_path(); // of "folder/"
  std::error_code unknown;
  if (std::filesystem::symlink_status(place_.path, unknown).type() !=
      std::filesystem::file_type::not_found) {
    kept_ = true;
    return;
  }
  for (int& one : spare_)
    if ((one = openRetrying("/dev/null", O_RDONLY)) < 0) {
      const int cause = errno;
      giveSpareBack();
      throw DiskError(folder.string(), "cannot be made a folder: " + reason(cause));
    }
  unfinished_ = Unfinished(place_.path, whole);
}

void NewFolder::keep() noexcept {
  unfinished_.done();
  kept_ = true;
  const std::lock_guard hold(known().guard);
  known().any_finished = true;
}

void NewFolder::giveSpareBack() noexcept {
  for (int& one : spare_)
    if (one >= 0) ::close(std::exchange(one, -1));
}

NewFolder::~NewFolder() {
  giveSpareBack();
  if (!kept_) removeUnlessWhole(place_);
}

void removeUnfinished() noexcept {
  known().guard.lock();
  for (const Unfinished::Place& place : known().places) removeUnlessWhole(place);
}

bool anyFinished() noexcept {
  const std::lock_guard hold(known().guard);
  return known().any_finished;
}

} // namespace patina
