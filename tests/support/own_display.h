// An X server of the test program's own, so that its pictures do not depend on other programs on a
// shared server.
#pragma once

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <csignal>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace patina::test {

// A running Xvfb; it ends with this value, and with the thread that made it.
class XServer {
 public:
  // Absent: the server searches for a free number.
  explicit XServer(std::optional<int> number = std::nullopt) {
    int said[2];
    if (pipe2(said, O_CLOEXEC) != 0) return;
    said_ = said[0];
    const char* screen = std::getenv("PATINA_SCREEN"); // for tests of another size
    std::vector<std::string> words = {"Xvfb",     "-displayfd", std::to_string(said[1]),
                                      "-screen",  "0",          screen ? screen : "2560x1600x24",
                                      "-noreset", "-nolisten",  "tcp"};
    if (number) words.push_back(":" + std::to_string(*number));
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGTERM);
      fcntl(said[1], F_SETFD, 0);
      const int nowhere = open("/dev/null", O_RDWR);
      for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
      execvp("Xvfb", arguments.data());
      _exit(127);
    }
    close(said[1]);
  }
  ~XServer() {
    if (said_ >= 0) close(said_);
    if (pid_ <= 0) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  XServer(const XServer&) = delete;
  XServer& operator=(const XServer&) = delete;

  // Waits until the server answers. Absent if it cannot be started.
  std::optional<int> number() {
    std::string text;
    for (char c = 0; !number_ && said_ >= 0 && read(said_, &c, 1) == 1;)
      if (c != '\n')
        text += c;
      else
        number_ = std::stoi(text);
    return number_;
  }

 private:
  pid_t pid_ = -1;
  int said_ = -1;
  std::optional<int> number_;
};

// Returns whether pictures can be drawn: from the first call on DISPLAY names a server of this
// program's own, or, if Xvfb is not installed, that of the environment. Call it in the main thread.
inline bool hasDisplay() {
  static const bool has = [] {
    for (int i = 0; i < 3; ++i) {
      // The server lives as long as the program: a connection to it may be closed last of all.
      auto server = std::make_unique<XServer>();
      if (const auto number = server->number()) {
        setenv("DISPLAY", (":" + std::to_string(*number)).c_str(), 1);
        (void)server.release();
        break;
      }
    }
    return std::getenv("DISPLAY") != nullptr;
  }();
  return has;
}

} // namespace patina::test
