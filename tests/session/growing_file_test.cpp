// A growing file is on disk within a second, whatever happens to its program or the disk.
#include "session/store/growing_file.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "core/file.h"
#include "support/fresh_folder.h"
#include "support/small_disk.h"

namespace patina {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double monotonic() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

class GrowingFileTest : public ::testing::Test {
 protected:
  void SetUp() override { folder_ = test::freshFolder("growing"); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
  fs::path path() const { return folder_ / "log.csv"; }
};

TEST_F(GrowingFileTest, ReplacesAFileAtOnceAndGrowsWithinASecond) {
  std::ofstream(path()) << "an older log";
  GrowingFile file(path(), "t [s]\n");
  EXPECT_EQ(readFile(path()), "t [s]\n");
  EXPECT_TRUE(file.append("1\n"));
  const auto until = Clock::now() + std::chrono::seconds(20); // a loaded machine
  while (readFile(path()).size() < 8 && Clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(readFile(path()), "t [s]\n1\n");
  file.append("2\n");
  file.flush();
  EXPECT_EQ(readFile(path()), "t [s]\n1\n2\n");
  EXPECT_TRUE(file.problem().empty());
}

TEST_F(GrowingFileTest, EndOfTheObjectWritesTheRest) {
  { GrowingFile(path(), "a").append("b"); }
  EXPECT_EQ(readFile(path()), "ab");
}

TEST_F(GrowingFileTest, KilledProgramLosesAtMostTheLastSecond) {
  const pid_t child = fork();
  if (child == 0) {
    GrowingFile file(path(), "");
    for (;;) {
      std::ostringstream line;
      line.precision(17);
      line << monotonic() << '\n';
      file.append(line.str());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(3300));
  const double end = monotonic();
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  std::istringstream lines(readFile(path()));
  double first = 0, last = 0;
  std::size_t count = 0;
  for (double t = 0; lines >> t; ++count, last = t)
    if (count == 0) first = t;
  EXPECT_GT(count, 500U);
  EXPECT_LT(first, end - 2);
  EXPECT_GT(last, end - 1);
}

TEST_F(GrowingFileTest, FullDiskKeepsTheBytesUntilThereIsRoom) {
  GrowingFile file(path(), "start\n");
  {
    const test::SmallDisk full(10);
    EXPECT_TRUE(file.append("too long for it\n"));
    EXPECT_THROW(file.flush(), FileError);
    EXPECT_NE(file.problem().find("log.csv"), std::string::npos) << file.problem();
    EXPECT_TRUE(file.append("later\n"));
    EXPECT_THROW(file.flush(), FileError);
    EXPECT_EQ(readFile(path()), "start\n");
  }
  file.flush();
  EXPECT_EQ(readFile(path()), "start\ntoo long for it\nlater\n");
  EXPECT_TRUE(file.problem().empty());
}

TEST_F(GrowingFileTest, FullDiskHoldsABoundedAmount) {
  GrowingFile file(path(), "");
  const std::string piece(std::size_t{1} << 16, 'x');
  std::size_t taken = 0;
  {
    const test::SmallDisk full(1);
    for (int i = 0; i < 400; ++i) {
      if (file.append(piece)) taken += piece.size();
      if (i == 10) {
        EXPECT_THROW(file.flush(), FileError);
      }
    }
  }
  EXPECT_GE(taken, GrowingFile::kMostWaiting - piece.size());
  EXPECT_LE(taken, 2 * GrowingFile::kMostWaiting);
  file.flush();
  EXPECT_EQ(fs::file_size(path()), taken);
}

TEST_F(GrowingFileTest, SecondWriterIsRefusedAndChangesNothing) {
  GrowingFile file(path(), "first");
  EXPECT_THROW(GrowingFile(path(), "second"), FileError);
  file.append(" writer");
  file.flush();
  EXPECT_EQ(readFile(path()), "first writer");
}

TEST_F(GrowingFileTest, WritesThroughALinkAndIntoADevice) {
  fs::create_symlink(folder_ / "target", path());
  { GrowingFile(path(), "a").append("b"); }
  EXPECT_TRUE(fs::is_symlink(path()));
  EXPECT_EQ(readFile(folder_ / "target"), "ab");
  GrowingFile nowhere("/dev/null", "a");
  EXPECT_TRUE(nowhere.append("b"));
  nowhere.flush();
}

TEST_F(GrowingFileTest, PipeWhoseReaderHasEndedTakesNoMore) {
  const auto former = std::signal(SIGPIPE, SIG_IGN);
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  {
    GrowingFile file("/dev/fd/" + std::to_string(ends[1]), "a");
    close(ends[0]);
    EXPECT_TRUE(file.append("b"));
    EXPECT_THROW(file.flush(), FileError);
    EXPECT_FALSE(file.append("c"));
  }
  close(ends[1]);
  std::signal(SIGPIPE, former);
}

TEST_F(GrowingFileTest, MissingFolderIsRefused) {
  EXPECT_THROW(GrowingFile(folder_ / "absent" / "log.csv", ""), FileError);
}

} // namespace
} // namespace patina
