// Errors of the world (file, device, display). Numerical failure is a report, never one of these.
#pragma once

#include <stdexcept>
#include <string>

namespace patina {

// One line for a person: what is wrong and, where there is one, what to do. Exit code 2.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A file that cannot be read or written. what() is "path:line: cause", or "path: cause" if line ==
// 0.
class FileError : public Error {
 public:
  FileError(const std::string& path, std::size_t line, const std::string& cause)
      : Error(path + (line ? ":" + std::to_string(line) : "") + ": " + cause), path_(path),
        line_(line) {}
  const std::string& path() const { return path_; }
  std::size_t line() const { return line_; } // 1-based; 0 = the file as a whole

 private:
  std::string path_;
  std::size_t line_;
};

// A device that cannot be opened or stopped answering.
class DeviceError : public Error {
 public:
  using Error::Error;
};

// The person cancelled a long operation; the state is as before it began. No Error: what adds a
// file's or an object's name to an Error lets it through as it is.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

} // namespace patina
