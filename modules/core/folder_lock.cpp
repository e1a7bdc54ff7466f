#include "core/folder_lock.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>

#include "core/error.h"

namespace patina {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : folder_(openRetrying(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY)) {
  if (folder_.get() < 0) throw FileError(folder.string(), 0, "cannot be opened: " + reason(errno));
  int result;
  do {
    result = ::flock(folder_.get(), LOCK_EX);
  } while (result != 0 && errno == EINTR);
}

} // namespace patina
