// The real program, run from outside: words in, exit code and two streams out. No shell.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <sys/types.h>
#include <utility>
#include <vector>

#include "core/json.h"

namespace patina::test {

struct Outcome {
  int exit = -1; // 128 + signal if one ended it
  std::string out, err;
};

// A started program; its streams go to files, so that it never waits for a reader.
class Running {
 public:
  // stderr may be given another file, such as a terminal; it is then not part of the outcome.
  Running(const std::vector<std::string>& words, const std::filesystem::path& program,
          const std::filesystem::path& stderr_to = {});
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void signal(int number) const;
  bool catches(int number) const; // it has a handler of its own
  bool hasThread(const std::string& name) const;
  bool finished(); // without waiting
  std::size_t residentBytes() const;
  Outcome wait();

 private:
  std::filesystem::path out_, err_;
  pid_t pid_ = -1;
  bool reaped_ = false;
  int status_ = 0;
};

std::filesystem::path programPath(); // the patina under test
Outcome run(const std::vector<std::string>& words);
// Expects exit 0 and one JSON object on stdout.
Json runJson(std::vector<std::string> words);

// Expects exit 2, nothing on stdout and one line "patina: ..." that holds every part.
void expectOneLineError(const Outcome& outcome, const std::vector<std::string>& parts);

// A fresh folder, removed with its content.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

// Sets variables for the programs that are started in its lifetime.
class Environment {
 public:
  explicit Environment(std::vector<std::pair<std::string, std::string>> settings)
      : settings_(std::move(settings)) {
    for (const auto& [name, value] : settings_) setenv(name.c_str(), value.c_str(), 1);
  }
  ~Environment() {
    for (const auto& [name, value] : settings_) unsetenv(name.c_str());
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::vector<std::pair<std::string, std::string>> settings_;
};

std::string firstLine(const std::filesystem::path& path);

} // namespace patina::test
