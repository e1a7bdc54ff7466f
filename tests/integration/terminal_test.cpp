// The progress bar: on a terminal only.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fcntl.h>
#include <unistd.h>

#include "integration/program.h"

namespace patina::test {
namespace {

// The reading end of a pseudo-terminal.
class Terminal {
 public:
  Terminal() : fd_(posix_openpt(O_RDWR | O_NOCTTY)) {
    if (fd_ < 0 || grantpt(fd_) != 0 || unlockpt(fd_) != 0) return;
    char name[128];
    if (ptsname_r(fd_, name, sizeof name) == 0) path_ = name;
    // Held open, so that what was written outlives the program.
    held_ = open(path_.c_str(), O_RDWR | O_NOCTTY);
  }
  ~Terminal() {
    if (held_ >= 0) close(held_);
    if (fd_ >= 0) close(fd_);
  }
  const std::string& path() const { return path_; }
  std::string shown() const {
    fcntl(fd_, F_SETFL, O_NONBLOCK);
    std::string text;
    char buffer[4096];
    for (ssize_t n; (n = read(fd_, buffer, sizeof buffer)) > 0;)
      text.append(buffer, static_cast<std::size_t>(n));
    return text;
  }

 private:
  int fd_, held_ = -1;
  std::string path_;
};

TEST(ProgressBar, IsDrawnOnATerminalAndErased) {
  const ScratchFolder folder;
  const std::string mesh = folder / "torus.ply";
  ASSERT_EQ(run({"model", "torus", "-o", mesh}).exit, 0);
  const Terminal terminal;
  if (terminal.path().empty()) GTEST_SKIP() << "no pseudo-terminal here";
  Running field({"field", mesh, "-o", folder / "f.vti"}, programPath(), terminal.path());
  EXPECT_EQ(field.wait().exit, 0);
  const std::string shown = terminal.shown();
  EXPECT_NE(shown.find("\r["), std::string::npos) << shown;
  EXPECT_TRUE(shown.ends_with("\r\033[K")) << shown;
}

TEST(ProgressBar, IsNotDrawnIntoAFile) {
  const ScratchFolder folder;
  const std::string mesh = folder / "torus.ply";
  ASSERT_EQ(run({"model", "torus", "-o", mesh}).exit, 0);
  EXPECT_EQ(run({"field", mesh, "-o", folder / "f.vti"}).err, "");
}

} // namespace
} // namespace patina::test
