#include "core/unfinished.h"

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
  std::list<std::filesystem::path> paths;
};
Known& known() {
  static Known* const all = new Known; // never destroyed: the last to use it is exit itself
  return *all;
}

} // namespace

Unfinished::Unfinished(const std::filesystem::path& path) : held_(true) {
  const std::lock_guard hold(known().guard);
  place_ = known().paths.insert(known().paths.end(), std::filesystem::absolute(path));
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
  known().paths.erase(place_);
}

NewFolder::NewFolder(const std::filesystem::path& folder) : folder_(folder) {
  std::error_code unknown;
  if (std::filesystem::symlink_status(folder, unknown).type() !=
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
  unfinished_ = Unfinished(folder);
}

void NewFolder::giveSpareBack() noexcept {
  for (int& one : spare_)
    if (one >= 0) ::close(std::exchange(one, -1));
}

NewFolder::~NewFolder() {
  giveSpareBack();
  if (kept_) return;
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void removeUnfinished() noexcept {
  known().guard.lock();
  for (const std::filesystem::path& path : known().paths) {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
}

} // namespace patina
