// System calls on files that retry after signals (EINTR).
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <utility>

namespace patina {

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  void reset(int fd) { // the old descriptor must be closed
    fd_ = fd;
  }
  int release() { // the caller then owns the descriptor
    return std::exchange(fd_, -1);
  }
  // Returns 0, or -1 and errno; a full disk may show only here.
  int close();

 private:
  int fd_;
};

int openRetrying(const char* path, int flags, mode_t mode = 0);
// Time to wait for another process to open the other end of a pipe.
constexpr std::chrono::milliseconds kPipeTimeout{5000};
// Opens for reading; "-" is standard input. Throws FileError if the file is missing, a cycle of
// links, or a pipe without a writer within the timeout; DiskError otherwise.
int openToRead(const std::filesystem::path& path, std::chrono::milliseconds timeout = kPipeTimeout);
// Opens a device or a pipe for writing. Throws FileError if no process opens the pipe for reading
// within five seconds. Returns -1 and sets errno on other failures.
int openStream(const std::string& name);
bool syncRetrying(int fd);
// Both return false and set errno on failure; part of the bytes may then be written.
bool writeAll(int fd, std::string_view bytes); // at the current position
bool writeAllAt(int fd, std::string_view bytes, std::int64_t offset);
// Reads up to `capacity` bytes and returns their number, 0 at the end. Throws DiskError(name).
std::size_t readSome(int fd, const std::string& name, char* buffer, std::size_t capacity);
// Reads from the current position to the end. Throws FileError(name).
std::string readAll(int fd, const std::string& name);
std::string reason(int code); // text for an errno value

} // namespace patina
