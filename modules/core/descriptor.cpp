#include "core/descriptor.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <future>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "core/disk_error.h"
#include "core/output_target.h"

namespace patina {

int Descriptor::close() {
  if (fd_ < 0) return 0;
  const int result = ::close(fd_);
  fd_ = -1;
  // Linux has closed it by then; closing again could hit another file.
  return result != 0 && errno == EINTR ? 0 : result;
}

int openRetrying(const char* path, int flags, mode_t mode) {
  int fd;
  do {
    fd = ::open(path, flags | O_CLOEXEC, mode);
  } while (fd < 0 && errno == EINTR);
  return fd;
}

namespace {

constexpr std::chrono::seconds kPatience{5}; // with who is to be at a pipe's other end

// The file system says only to a reader that waits whether anybody writes. Who waits too long is
// let go by a writer of our own.
int openPipe(const std::string& name) {
  struct Opened {
    int fd, code; // errno is each thread's own
  };
  std::promise<Opened> opened;
  std::future<Opened> ready = opened.get_future();
  std::thread reader([&] {
    const int fd = openRetrying(name.c_str(), O_RDONLY);
    opened.set_value({fd, errno});
  });
  const bool waits = ready.wait_for(kPatience) == std::future_status::timeout;
  if (waits) Descriptor(openRetrying(name.c_str(), O_WRONLY | O_NONBLOCK));
  reader.join();
  const auto [fd, code] = ready.get();
  errno = code;
  if (!waits) return fd;
  Descriptor unused(fd);
  throw FileError(name, 0, "is a pipe that nobody writes: nothing came for 5 s");
}

} // namespace

int openToRead(const std::filesystem::path& path) {
  if (isStandardStream(path)) return ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3);
  const std::string name = path.string();
  struct stat info {};
  const bool pipe = ::stat(name.c_str(), &info) == 0 && S_ISFIFO(info.st_mode) &&
                    !path.string().starts_with("/dev/") && !path.string().starts_with("/proc/");
  const int fd = pipe ? openPipe(name) : openRetrying(name.c_str(), O_RDONLY);
  if (fd >= 0) return fd;
  const int code = errno;
  const std::string cause = "cannot be opened: " + reason(code);
  if (code == ENOENT || code == ENOTDIR || code == ELOOP || code == EACCES)
    throw FileError(name, 0, cause);
  throw DiskError(name, cause);
}

int openStream(const std::string& name) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  int fd = openRetrying(name.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK);
  while (fd < 0 && errno == ENXIO && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    fd = openRetrying(name.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK);
  }
  if (fd < 0 && errno == ENXIO)
    throw FileError(name, 0, "is a pipe that nobody reads: nobody came for 5 s");
  if (fd >= 0) ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) & ~O_NONBLOCK);
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
    if (written >= 0)
      bytes.remove_prefix(static_cast<std::size_t>(written));
    else if (errno != EINTR)
      return false;
  }
  return true;
}

bool writeAllAt(int fd, std::string_view bytes, std::int64_t offset) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(fd, bytes.data(), bytes.size(), offset);
    if (written < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += written;
  }
  return true;
}

std::size_t readSome(int fd, const std::string& name, char* buffer, std::size_t room) {
  for (;;) {
    const ssize_t got = ::read(fd, buffer, room);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) throw DiskError(name, "cannot be read: " + reason(errno));
  }
}

std::string readAll(int fd, const std::string& name) {
  struct stat info {};
  if (::fstat(fd, &info) != 0) throw DiskError(name, "cannot be read: " + reason(errno));
  if (S_ISDIR(info.st_mode)) throw FileError(name, 0, "is a folder, not a file");
  std::string bytes;
  // One byte more than the size, so that the end is seen without another growth.
  std::size_t room = info.st_size > 0 ? static_cast<std::size_t>(info.st_size) + 1 : 65536;
  std::size_t used = 0;
  for (;;) {
    bytes.resize(used + room);
    const std::size_t got = readSome(fd, name, bytes.data() + used, room);
    used += got;
    if (got == 0) break;
    room = std::max<std::size_t>(bytes.size() - used, 65536);
  }
  bytes.resize(used);
  return bytes;
}

std::string reason(int code) {
  return std::strerror(code);
}

} // namespace patina
