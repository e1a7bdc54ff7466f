#include "core/file.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"

namespace patina {
namespace {

std::string reason(int code) {
  return std::strerror(code);
}

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  // A full disk may show only here.
  int close() {
    const int result = ::close(fd_);
    fd_ = -1;
    return result;
  }

 private:
  int fd_;
};

int openRetrying(const char* path, int flags, mode_t mode = 0) {
  int fd;
  do {
    fd = ::open(path, flags | O_CLOEXEC, mode);
  } while (fd < 0 && errno == EINTR);
  return fd;
}

bool syncRetrying(int fd) {
  int result;
  do {
    result = ::fsync(fd);
  } while (result != 0 && errno == EINTR);
  // Some file systems cannot sync a folder and say so with EINVAL: nothing more can be done there.
  return result == 0 || errno == EINVAL;
}

bool writeAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

struct Temporary {
  int fd;
  std::string name;
};

// Beside the target, because a rename is atomic only within one file system. Created with the
// permissions that a plain open would give, which mkstemp does not.
Temporary createBeside(const std::string& folder, const std::string& filename) {
  static std::atomic<unsigned> counter{0};
  for (;;) {
    std::string name = folder + "/." + filename + "." + std::to_string(::getpid()) + "-" +
                       std::to_string(counter.fetch_add(1)) + ".tmp";
    const int fd = openRetrying(name.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (fd >= 0 || errno != EEXIST) return {fd, std::move(name)};
  }
}

} // namespace

std::string readFile(const std::filesystem::path& path) {
  const std::string name = path.string();
  const Descriptor file(openRetrying(name.c_str(), O_RDONLY));
  if (file.get() < 0) throw FileError(name, 0, "cannot be opened: " + reason(errno));
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) {
    throw FileError(name, 0, "cannot be read: " + reason(errno));
  }
  if (S_ISDIR(info.st_mode)) throw FileError(name, 0, "is a folder, not a file");

  std::string bytes;
  // One byte more than the size, so that the end is seen without another growth.
  std::size_t room = info.st_size > 0 ? static_cast<std::size_t>(info.st_size) + 1 : 65536;
  std::size_t used = 0;
  for (;;) {
    bytes.resize(used + room);
    const ssize_t got = ::read(file.get(), bytes.data() + used, room);
    if (got < 0) {
      if (errno == EINTR) continue;
      throw FileError(name, 0, "cannot be read: " + reason(errno));
    }
    used += static_cast<std::size_t>(got);
    if (got == 0) break;
    room = std::max<std::size_t>(bytes.size() - used, 65536);
  }
  bytes.resize(used);
  return bytes;
}

void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes) {
  const std::string name = path.string();
  const std::filesystem::path parent = path.parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  struct stat old {};
  const bool exists = ::stat(name.c_str(), &old) == 0;
  // The rename below would put a file where a device or a pipe was.
  if (exists && !S_ISREG(old.st_mode)) throw FileError(name, 0, "cannot be written: not a file");
  const Temporary temporary = createBeside(folder, path.filename().string());
  Descriptor file(temporary.fd);
  if (file.get() < 0) throw FileError(name, 0, "cannot be written: " + reason(errno));
  const auto fail = [&](const std::string& what) {
    const int code = errno;
    ::unlink(temporary.name.c_str());
    throw FileError(name, 0, what + ": " + reason(code));
  };
  if (!writeAll(file.get(), bytes)) fail("cannot be written");
  if (exists && ::fchmod(file.get(), old.st_mode & 07777) != 0) fail("cannot be written");
  if (!syncRetrying(file.get())) fail("cannot be flushed to disk");
  if (file.close() != 0) fail("cannot be written");
  if (::rename(temporary.name.c_str(), name.c_str()) != 0) fail("cannot be replaced");

  // Without this the new name may be lost with the power, though the bytes are safe.
  const Descriptor directory(openRetrying(folder.c_str(), O_RDONLY | O_DIRECTORY));
  if (directory.get() < 0 || !syncRetrying(directory.get())) {
    throw FileError(name, 0, "was written, but its folder cannot be flushed: " + reason(errno));
  }
}

} // namespace patina
