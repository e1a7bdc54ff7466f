#include "integration/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/file.h"
#include "support/fresh_folder.h"
#include "support/places.h"
#include "support/resident.h"

extern char** environ;

namespace patina::test {

namespace {

std::filesystem::path freshName(const std::string& what) {
  static std::atomic<int> counter{0};
  std::filesystem::path path;
  do { // a killed test may have left a folder
    path = std::filesystem::temp_directory_path() /
           ("patina-test-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + what);
  } while (std::filesystem::exists(path));
  return path;
}

} // namespace

std::filesystem::path programPath() {
  return programFolder() / "patina";
}

Running::Running(const std::vector<std::string>& words, const std::filesystem::path& program,
                 const std::filesystem::path& stderr_to)
    : out_(freshName(".out")), err_(freshName(".err")) {
  std::vector<std::string> all = {program.string()};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (std::string& word : all) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), flags, 0600);
  std::ofstream(err_).flush();
  const std::filesystem::path& errors = stderr_to.empty() ? err_ : stderr_to;
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors.c_str(), flags, 0600);
  const int error = posix_spawnp(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error) {
    reaped_ = true;
    status_ = 127 << 8;
    std::ofstream(out_).flush();
    std::ofstream(err_) << "cannot start " << argv[0];
  }
}

Running::~Running() {
  if (!reaped_) {
    kill(pid_, SIGKILL);
    waitpid(pid_, &status_, 0);
  }
  std::error_code ignored;
  std::filesystem::remove(out_, ignored);
  std::filesystem::remove(err_, ignored);
}

void Running::signal(int number) const {
  if (!reaped_) kill(pid_, number);
}

bool Running::catches(int number) const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("SigCgt:"))
      return std::stoull(line.substr(7), nullptr, 16) >> (number - 1) & 1;
  return false;
}

bool Running::hasThread(const std::string& name) const {
  std::error_code ended;
  for (const auto& task :
       std::filesystem::directory_iterator("/proc/" + std::to_string(pid_) + "/task", ended))
    if (firstLine(task.path() / "comm") == name) return true;
  return false;
}

std::size_t Running::residentBytes() const {
  return patina::test::residentBytes(std::to_string(pid_));
}

bool Running::finished() {
  if (!reaped_ && waitpid(pid_, &status_, WNOHANG) == pid_) reaped_ = true;
  return reaped_;
}

Outcome Running::wait() {
  while (!reaped_)
    if (waitpid(pid_, &status_, 0) == pid_ || errno != EINTR) reaped_ = true;
  Outcome outcome;
  outcome.exit = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  outcome.out = readFile(out_);
  outcome.err = readFile(err_);
  return outcome;
}

Outcome run(const std::vector<std::string>& words) {
  return Running(words, programPath()).wait();
}

Json runJson(std::vector<std::string> words) {
  words.push_back("--json");
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  return outcome.exit == 0 ? parseJson(outcome.out, "stdout") : Json::object();
}

void expectOneLineError(const Outcome& outcome, const std::vector<std::string>& parts) {
  EXPECT_EQ(outcome.exit, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(outcome.err.starts_with("patina: ")) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  for (const std::string& part : parts)
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " in: " << outcome.err;
}

ScratchFolder::ScratchFolder() : path_(freshFolder("test")) {}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string ScratchFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return (path_ / name).string();
}

std::string firstLine(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  return line;
}

} // namespace patina::test
