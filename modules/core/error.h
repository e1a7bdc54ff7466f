// Errors of the environment (file, device, display). Numerical failures are reported as results.
#pragma once

#include <stdexcept>
#include <string>

namespace patina {

// One line for the user: the fault and, if there is one, the remedy. Exit code 2.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A file that cannot be read or written. what() is "path:line: cause", without ":line" if it is 0.
class FileError : public Error {
 public:
  FileError(const std::string& path, std::size_t line, const std::string& cause)
      : Error(path + (line ? ":" + std::to_string(line) : "") + ": " + cause), path_(path),
        line_(line) {}
  const std::string& path() const { return path_; }
  std::size_t line() const { return line_; } // 1-based; 0: the whole file

 private:
  std::string path_;
  std::size_t line_;
};

// A device that cannot be opened or that stopped responding.
class DeviceError : public Error {
 public:
  using Error::Error;
};

// The user cancelled a long operation; the state is as before it began. Not an Error, so that code
// which adds a file or object name to an Error passes it on unchanged.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

} // namespace patina
