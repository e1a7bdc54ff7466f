#include "core/append_file.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/disk_error.h"

namespace patina {
namespace {

int openedToAppend(const std::string& name) {
  const int fd = openRetrying(name.c_str(), O_RDWR);
  if (fd < 0) throw DiskError(name, "cannot be opened for writing: " + reason(errno));
  return fd;
}

} // namespace

void createFile(const std::filesystem::path& path, std::string_view bytes) {
  const std::string name = path.string();
  Descriptor file(openRetrying(name.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666));
  if (file.get() < 0) throw DiskError(name, "cannot be written: " + reason(errno));
  if (writeAllAt(file.get(), bytes, 0) && file.close() == 0) return;
  const int code = errno;
  ::unlink(name.c_str());
  throw DiskError(name, "cannot be written: " + reason(code));
}

AppendFile::AppendFile(const std::filesystem::path& path)
    : name_(path.string()), file_(openedToAppend(name_)),
      lock_(file_.get(), path, FileLock::Wait::no) {
  struct stat info {};
  if (::fstat(file_.get(), &info) != 0)
    throw FileError(name_, 0, "cannot be read: " + reason(errno));
  if (info.st_nlink == 0) throw FileError(name_, 0, "was replaced meanwhile; open it again");
  size_ = static_cast<std::uint64_t>(info.st_size);
}

std::string AppendFile::content() const {
  ::lseek(file_.get(), 0, SEEK_SET);
  std::string bytes = readAll(file_.get(), name_);
  if (bytes.size() > size_) bytes.resize(size_);
  return bytes;
}

bool AppendFile::cut(std::uint64_t size) {
  int result;
  do {
    result = ::ftruncate(file_.get(), static_cast<off_t>(size));
  } while (result != 0 && errno == EINTR);
  return result == 0 && syncRetrying(file_.get());
}

void AppendFile::truncate(std::uint64_t size) {
  if (!cut(size)) throw DiskError(name_, "cannot be cut: " + reason(errno));
  size_ = size;
  longer_ = false;
}

void AppendFile::append(std::string_view bytes) {
  struct stat info {};
  // Data written to an unlinked file would be lost when this program ends.
  if (::fstat(file_.get(), &info) == 0 && info.st_nlink == 0)
    throw FileError(name_, 0, "was removed or replaced by another program; save to another folder");
  if (longer_) truncate(size_);
  bool done = writeAllAt(file_.get(), bytes, static_cast<std::int64_t>(size_));
  const char* what = "cannot be written: ";
  if (done) {
    what = "cannot be flushed to disk: ";
    int result;
    do {
      result = ::fdatasync(file_.get()); // the size is flushed with the data
    } while (result != 0 && errno == EINTR);
    done = result == 0;
  }
  if (!done) {
    const int code = errno;
    longer_ = !cut(size_);
    const bool there = longer_ && ::fstat(file_.get(), &info) == 0 &&
                       static_cast<std::uint64_t>(info.st_size) > size_;
    throw DiskError(name_, what + reason(code) +
                               (there ? "; what was written of it cannot be taken back: look "
                                        "whether it is there before you try again"
                                      : ""));
  }
  size_ += bytes.size();
}

} // namespace patina
