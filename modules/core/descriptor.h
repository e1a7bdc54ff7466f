// System calls on files, with what signals interrupt done again. Internal to core's files.
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
  void reset(int fd) { // of one that is closed
    fd_ = fd;
  }
  int release() { // whose it is from now on
    return std::exchange(fd_, -1);
  }
  // A full disk may show only here: 0, or -1 and errno.
  int close();

 private:
  int fd_;
};

int openRetrying(const char* path, int flags, mode_t mode = 0);
// With who is to be at a pipe's other end.
constexpr std::chrono::milliseconds kPipePatience{5000};
// Open for reading; "-" is standard input. FileError: missing, a ring of links, a pipe that nobody
// has opened for writing in time; DiskError: anything else.
int openToRead(const std::filesystem::path& path,
               std::chrono::milliseconds patience = kPipePatience);
// Open for writing what is no file: a device, or a pipe. FileError if nobody has opened the pipe
// for reading after five seconds; else -1 and errno.
int openStream(const std::string& name);
bool syncRetrying(int fd);
// false and errno; part of the bytes may then be there.
bool writeAll(int fd, std::string_view bytes); // where it stands
bool writeAllAt(int fd, std::string_view bytes, std::int64_t offset);
// Up to `room` bytes, 0 at the end. Throws DiskError(name).
std::size_t readSome(int fd, const std::string& name, char* buffer, std::size_t room);
// The whole file from its beginning. Throws FileError(name).
std::string readAll(int fd, const std::string& name);
std::string reason(int code); // of errno, for people

} // namespace patina
