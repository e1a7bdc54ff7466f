#include "core/staged_folder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "core/file.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

// The number of a process that has ended.
pid_t endedProcess() {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  return child;
}

void write(const fs::path& folder, const std::string& text) {
  StagedFolder staged(folder, "last.txt");
  writeFileAtomically(staged.path() / "first.txt", text);
  writeFileAtomically(staged.path() / "last.txt", text);
  staged.commit();
}

// State left by a run that was killed between its files: the target folder has no index file.
class HalfWritten : public testing::Test {
 protected:
  void leave(pid_t process) {
    left_ = folder_ / (".writing-" + std::to_string(process) + "-0");
    fs::create_directory(left_);
    writeFileAtomically(left_ / "last.txt", "old");
    writeFileAtomically(folder_ / "first.txt", "old");
  }
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  const fs::path folder_ =
      fs::path(testing::TempDir()) / ("patina-staged-" + std::to_string(getpid()));
  fs::path left_;
};

TEST_F(HalfWritten, IsReplacedAndRemovedByTheNextRun) {
  leave(endedProcess());
  EXPECT_TRUE(isInterruptedWrite(folder_));
  write(folder_, "new");
  EXPECT_EQ(readFile(folder_ / "first.txt"), "new");
  EXPECT_EQ(readFile(folder_ / "last.txt"), "new");
  EXPECT_FALSE(fs::exists(left_));
  EXPECT_FALSE(isInterruptedWrite(folder_));
}

TEST_F(HalfWritten, IsKeptWhileItsProcessRuns) {
  leave(getppid());
  EXPECT_FALSE(isInterruptedWrite(folder_));
  EXPECT_THROW(write(folder_, "new"), FileError);
  EXPECT_EQ(readFile(folder_ / "first.txt"), "old");
  EXPECT_TRUE(fs::exists(left_));
}

} // namespace
} // namespace patina
