#include "core/descriptor.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "core/disk_error.h"
#include "core/numbers.h"
#include "core/output_target.h"

namespace patina {

int Descriptor::close() {
  if (fd_ < 0) return 0;
  const int result = ::close(fd_);
  fd_ = -1;
  // Linux closes the descriptor even on EINTR; closing it again could close another file.
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

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPause{20}; // poll interval of a pipe

// True if the pipe has a writer: copies the next byte, or gets EAGAIN from a silent writer.
bool hasOtherEnd(int pipe, int copy) {
  const ssize_t copied = ::tee(pipe, copy, 1, SPLICE_F_NONBLOCK);
  return copied > 0 || (copied < 0 && errno == EAGAIN);
}

// A blocking open would wait for a writer without a timeout.
int openPipe(const std::string& name, std::chrono::milliseconds timeout) {
  Descriptor pipe(openRetrying(name.c_str(), O_RDONLY | O_NONBLOCK));
  int copies[2] = {-1, -1};
  if (pipe.get() < 0 || ::pipe2(copies, O_CLOEXEC) != 0) return -1;
  const Descriptor out(copies[0]), in(copies[1]);
  const auto end = Clock::now() + timeout;
  while (!hasOtherEnd(pipe.get(), in.get())) {
    pollfd wait{pipe.get(), POLLIN, 0};
    ::poll(&wait, 1, static_cast<int>(kPause.count()));
    if (wait.revents & POLLHUP) break; // a writer connected and closed
    if (Clock::now() > end)
      throw FileError(name, 0,
                      "is a pipe without a writer: no program opened it within " +
                          formatNumber(std::chrono::duration<double>(timeout).count()) + " s");
  }
  ::fcntl(pipe.get(), F_SETFL, ::fcntl(pipe.get(), F_GETFL) & ~O_NONBLOCK);
  return pipe.release();
}

} // namespace

int openToRead(const std::filesystem::path& path, std::chrono::milliseconds timeout) {
  if (isStandardStream(path)) return ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3);
  const std::string name = path.string();
  struct stat info {};
  const bool pipe = ::stat(name.c_str(), &info) == 0 && S_ISFIFO(info.st_mode) &&
                    !path.string().starts_with("/dev/") && !path.string().starts_with("/proc/");
  const int fd = pipe ? openPipe(name, timeout) : openRetrying(name.c_str(), O_RDONLY);
  if (fd >= 0) return fd;
  const int code = errno;
  const std::string cause = "cannot be opened: " + reason(code);
  if (code == ENOENT || code == ENOTDIR || code == ELOOP || code == EACCES)
    throw FileError(name, 0, cause);
  throw DiskError(name, cause);
}

int openStream(const std::string& name) {
  const auto end = Clock::now() + kPipeTimeout;
  int fd = openRetrying(name.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK);
  while (fd < 0 && errno == ENXIO && Clock::now() < end) {
    std::this_thread::sleep_for(kPause);
    fd = openRetrying(name.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK);
  }
  if (fd < 0 && errno == ENXIO)
    throw FileError(name, 0, "is a pipe without a reader: no program opened it within 5 s");
  if (fd >= 0) ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) & ~O_NONBLOCK);
  return fd;
}

bool syncRetrying(int fd) {
  int result;
  do {
    result = ::fsync(fd);
  } while (result != 0 && errno == EINTR);
  // Some file systems cannot sync a folder and return EINVAL; nothing more can be done there.
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

std::size_t readSome(int fd, const std::string& name, char* buffer, std::size_t capacity) {
  for (;;) {
    const ssize_t got = ::read(fd, buffer, capacity);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) throw DiskError(name, "cannot be read: " + reason(errno));
  }
}

constexpr std::size_t kMaxOfADevice = std::size_t{64} << 20;

std::string readAll(int fd, const std::string& name) {
  struct stat info {};
  if (::fstat(fd, &info) != 0) throw DiskError(name, "cannot be read: " + reason(errno));
  if (S_ISDIR(info.st_mode)) throw FileError(name, 0, "is a folder, not a file");
  // One byte more than the size detects the end without another allocation.
  std::string bytes(info.st_size > 0 ? static_cast<std::size_t>(info.st_size) + 1 : 65536, '\0');
  std::size_t used = 0;
  const bool is_device = S_ISCHR(info.st_mode);
  for (std::size_t got = 1; got > 0; used += got) {
    if (is_device && used > kMaxOfADevice) throw FileError(name, 0, "does not end");
    if (used == bytes.size()) bytes.resize(used + 65536);
    got = readSome(fd, name, bytes.data() + used, bytes.size() - used);
  }
  bytes.resize(used);
  return bytes;
}

std::string reason(int code) {
  return std::strerror(code);
}

} // namespace patina
