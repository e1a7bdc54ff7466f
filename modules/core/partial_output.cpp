#include "core/partial_output.h"

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

// Global, because the file system is shared by the whole process.
struct Known {
  std::mutex guard;
  std::list<PartialOutput::Place> places;
  bool any_finished = false;
  std::vector<std::string> warnings;
};
Known& known() {
  static Known* const all = new Known; // never destroyed: exit handlers use it last
  return *all;
}

// Renames first: another process has completed the output, which is then detected, or fails.
void removeUnlessWhole(const PartialOutput::Place& place) noexcept {
  namespace fs = std::filesystem;
  const auto isWhole = [&](const fs::path& folder) {
    return !place.completion_marker.empty() &&
           ::access((folder / place.completion_marker).c_str(), F_OK) == 0;
  };
  if (isWhole(place.path)) return;
  fs::path aside = place.path;
  std::error_code ignored;
  if (!place.completion_marker.empty() ||
      fs::is_directory(place.path, ignored)) { // other processes may still write
    aside = place.path.parent_path() /
            ("." + place.path.filename().string() + "." + std::to_string(::getpid()) + ".tmp");
    if (::rename(place.path.c_str(), aside.c_str()) != 0) return;
    if (isWhole(aside) && ::rename(aside.c_str(), place.path.c_str()) == 0) return;
  }
  fs::remove_all(aside, ignored);
}

} // namespace

PartialOutput::PartialOutput(const std::filesystem::path& path,
                             const std::string& completion_marker)
    : held_(true) {
  const std::lock_guard hold(known().guard);
  auto& places = known().places;
  place_ = places.insert(places.end(), {std::filesystem::absolute(path), completion_marker});
}

PartialOutput::PartialOutput(PartialOutput&& other) noexcept
    : place_(other.place_), held_(std::exchange(other.held_, false)) {}

PartialOutput& PartialOutput::operator=(PartialOutput&& other) noexcept {
  std::swap(place_, other.place_);
  std::swap(held_, other.held_);
  return *this;
}

void PartialOutput::done() noexcept {
  if (!std::exchange(held_, false)) return;
  const std::lock_guard hold(known().guard);
  known().places.erase(place_);
}

int PartialOutput::finish(const std::function<int()>& last) {
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

NewFolder::NewFolder(const std::filesystem::path& folder, const std::string& completion_marker)
    : place_{std::filesystem::absolute(folder), completion_marker} {
  if (!place_.path.has_filename())
    place_.path = place_.path.parent_path(); // "folder/" has no file name
  std::error_code unknown;
  if (std::filesystem::symlink_status(place_.path, unknown).type() !=
      std::filesystem::file_type::not_found) {
    kept_ = true;
    return;
  }
  for (int& one : spare_)
    if ((one = openRetrying("/dev/null", O_RDONLY)) < 0) {
      const int cause = errno;
      releaseReserve();
      throw DiskError(folder.string(), "cannot be made a folder: " + reason(cause));
    }
  unfinished_ = PartialOutput(place_.path, completion_marker);
}

void NewFolder::keep() noexcept {
  unfinished_.done();
  kept_ = true;
  const std::lock_guard hold(known().guard);
  known().any_finished = true;
}

void NewFolder::releaseReserve() noexcept {
  for (int& one : spare_)
    if (one >= 0) ::close(std::exchange(one, -1));
}

NewFolder::~NewFolder() {
  releaseReserve();
  if (!kept_) removeUnlessWhole(place_);
}

void removeUnfinished() noexcept {
  known().guard.lock();
  for (const PartialOutput::Place& place : known().places) removeUnlessWhole(place);
}

bool hasCompleteOutput() noexcept {
  const std::lock_guard hold(known().guard);
  return known().any_finished;
}

void warnOfOutput(const std::string& line) {
  const std::lock_guard hold(known().guard);
  auto& lines = known().warnings;
  if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
}

std::vector<std::string> takeOutputWarnings() {
  const std::lock_guard hold(known().guard);
  return std::exchange(known().warnings, {});
}

} // namespace patina
