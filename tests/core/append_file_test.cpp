#include "core/append_file.h"

#include <csignal>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "core/file.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class AppendFileTest : public testing::Test {
 protected:
  AppendFileTest()
      : folder(fs::path(testing::TempDir()) / ("patina_append_" + std::to_string(getpid()))),
        path(folder / "log") {
    fs::create_directories(folder);
    writeFileAtomically(path, "begin\n");
  }
  ~AppendFileTest() override { fs::remove_all(folder); }
  fs::path folder, path;
};

TEST_F(AppendFileTest, PiecesFollowOneAnother) {
  AppendFile file(path);
  EXPECT_EQ(file.size(), 6u);
  file.append("one\n");
  EXPECT_EQ(file.content(), "begin\none\n");
  file.append(std::string(100000, 'x'));
  EXPECT_EQ(readFile(path), "begin\none\n" + std::string(100000, 'x'));
  file.truncate(6);
  file.append("two\n");
  EXPECT_EQ(readFile(path), "begin\ntwo\n");
}

TEST_F(AppendFileTest, ReplacedFileIsNotWritten) {
  AppendFile file(path);
  file.append("one\n");
  writeFileAtomically(path, "theirs\n");
  EXPECT_THROW(file.append("two\n"), FileError);
  fs::remove(path);
  EXPECT_THROW(file.append("two\n"), FileError);
  EXPECT_EQ(file.size(), 10u);
}

TEST_F(AppendFileTest, HasOneWriterAtATime) {
  {
    const AppendFile first(path);
    EXPECT_THROW(AppendFile second(path), FileError);
    const pid_t child = fork();
    if (child == 0) {
      try {
        const AppendFile other(path);
      } catch (const FileError&) {
        _exit(7);
      }
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 7);
  }
  const AppendFile free_again(path);
}

TEST_F(AppendFileTest, MustExist) {
  EXPECT_THROW(AppendFile(folder / "none"), FileError);
  EXPECT_FALSE(fs::exists(folder / "none"));
}

TEST_F(AppendFileTest, FullDiskLeavesNoPartOfAPiece) {
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN); // a short write, then an error, as on a full disk
    const rlimit limit{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &limit);
    int refused = 0;
    AppendFile file(path);
    try {
      file.append(std::string(5000, 'n'));
    } catch (const FileError&) {
      ++refused;
    }
    const bool cut = readFile(path) == "begin\n";
    file.append("small\n");
    _exit(refused == 1 && cut ? 7 : 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_EQ(readFile(path), "begin\nsmall\n");
}

} // namespace
} // namespace patina
