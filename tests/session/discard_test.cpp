// Discarding restores the saved state despite disk errors and other programs.
#include <atomic>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/append_file.h"
#include "core/error.h"
#include "session/edit/editor.h"
#include "session/edit_desk.h"
#include "session/store/workspace_storage.h"
#include "support/longer.h"
#include "support/places.h"
#include "workspace/manifest.h"

namespace patina {
namespace {

namespace fs = std::filesystem;
using namespace test;

void set(Editor& editor, const std::string& stiffness) {
  Progress progress;
  editor.apply(ValueEdit{{{"stiffness", stiffness}}}, progress);
}

class Discard : public testing::Test {
 protected:
  // An editor saved at 610 N/m.
  std::unique_ptr<Editor> saved(const fs::path& place) {
    auto editor = std::make_unique<Editor>(oneBall(30, 4), progress);
    set(*editor, "610");
    editor->saveAs(place);
    return editor;
  }
  // Runs a process whose disk fails one call of a discard; false if no such call is left.
  static bool refused(const char* fault, int at, const fs::path& place) {
    const fs::path mark = place.string() + ".mark";
    fs::remove(mark);
    const pid_t child = ::fork();
    if (child == 0) {
      const char* options = std::getenv("ASAN_OPTIONS"); // its runtime must be the first library
      const std::string with = std::string(options ? options : "") + ":verify_asan_link_order=0";
      ::setenv("ASAN_OPTIONS", with.c_str(), 1);
      ::setenv("LD_PRELOAD", preloadable("fault_shim.so").c_str(), 1);
      ::setenv("PATINA_FAULT", fault, 1);
      ::setenv("PATINA_FAULT_READS", "1", 1);
      ::setenv("PATINA_FAULT_WIDER", "1", 1);
      ::setenv("PATINA_FAULT_UNDER", place.c_str(), 1);
      ::setenv("PATINA_FAULT_MARK", mark.c_str(), 1);
      ::setenv("PATINA_TEST_CALL", std::to_string(at).c_str(), 1);
      ::execl("/proc/self/exe", "session_tests", "--gtest_also_run_disabled_tests",
              "--gtest_brief=1", "--gtest_filter=Discard.DISABLED_OnADiskThatRefusesACall",
              nullptr);
      ::_exit(127);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << fault << " at call " << at;
    return fs::exists(mark);
  }
  const Folder folder;
  Progress progress;
};

// Runs in a separate process.
TEST_F(Discard, DISABLED_OnADiskThatRefusesACall) {
  const fs::path place = std::getenv("PATINA_FAULT_UNDER");
  auto editor = saved(place);
  set(*editor, "620");
  set(*editor, "630");
  ::setenv("PATINA_FAULT_AT", std::getenv("PATINA_TEST_CALL"), 1);
  bool done = true;
  try {
    editor->revert(progress);
  } catch (const FileError&) {
    done = false;
  }
  ::unsetenv("PATINA_FAULT_AT");
  EXPECT_EQ(editor->unsaved(), !done);
  EXPECT_EQ(editor->scene().haptics.stiffness, done ? 610 : 630);
  EXPECT_EQ(editor->history().undoable(), done ? 1U : 3U);
  ASSERT_EQ(editor->folder(), place);
  set(*editor, "640"); // edits and the journal continue from there
  set(*editor, "650");
  EXPECT_EQ(editor->undo(1, progress), 1U);
  const std::vector<std::string> edits = editor->history().descriptions();
  editor.reset();
  editor = Editor::open(place, {}, progress);
  EXPECT_EQ(editor->scene().haptics.stiffness, 640);
  EXPECT_EQ(editor->history().descriptions(), edits);
  EXPECT_EQ(editor->history().redoable(), 1U);
}

TEST_F(Discard, IsAtomicIfAnyDiskCallFails) {
  const int stride = isLong() ? 1 : 5;
  for (const char* fault : {"eio", "enospc", "eintr", "estale", "enolck"}) {
    int at = 1;
    while (at < 300 && refused(fault, at, folder.path() / (fault + std::to_string(at))))
      at += stride;
    std::printf("%s: %d calls\n", fault, at - 1);
    EXPECT_GT(at, 20); // fewer would mean that the shim is not there
    EXPECT_LT(at, 300);
  }
}

TEST_F(Discard, KeepsTheIntentsOfTheEditsThatStay) {
  const fs::path place = folder.path() / "intents";
  saved(place).reset();
  auto editor = Editor::open(place, {.intent = "stays"}, progress);
  set(*editor, "620");
  editor->save();
  editor.reset();
  editor = Editor::open(place, {.intent = "goes"}, progress);
  set(*editor, "630");
  editor->revert(progress);
  editor.reset();
  EXPECT_TRUE(Editor::open(place, {.intent = "stays"}, progress)->isRepeated());
  EXPECT_FALSE(Editor::open(place, {.intent = "goes"}, progress)->isRepeated());
}

TEST_F(Discard, EditsMadeTogetherAreInTheFolderTogether) {
  const fs::path place = folder.path() / "together";
  saved(place).reset();
  const std::size_t before = openHistory(place).journal.size();
  auto editor = Editor::open(place, {.all_or_none = true}, progress);
  for (const char* value : {"620", "630", "640"}) set(*editor, value);
  EXPECT_EQ(editor->undo(1, progress), 1U);
  EXPECT_EQ(openHistory(place).journal.size(), before);
  editor->commit();
  EXPECT_EQ(openHistory(place).journal.size(), before + 4);
  set(*editor, "650"); // is not committed
  editor.reset();
  editor = Editor::open(place, {}, progress);
  EXPECT_EQ(editor->scene().haptics.stiffness, 630);
  EXPECT_EQ(editor->history().redoable(), 1U);
}

// At any moment only its writer can open the journal that workspace.json names.
TEST_F(Discard, KeepsTheJournalLocked) {
  const fs::path place = folder.path() / "ws";
  auto editor = saved(place);
  std::atomic<bool> over{false};
  std::atomic<int> tries{0}, taken{0};
  std::thread other([&] {
    while (!over) {
      ++tries;
      try {
        const AppendFile journal(place / readManifest(place).journal->file);
        ++taken;
      } catch (const Error&) {
      }
    }
  });
  for (int i = 0; i < 20; ++i) {
    set(*editor, "620");
    EXPECT_NO_THROW(editor->revert(progress)) << i;
    EXPECT_EQ(editor->scene().haptics.stiffness, 610);
  }
  over = true;
  other.join();
  EXPECT_EQ(taken, 0);
  EXPECT_GT(tries, 20);
}

} // namespace
} // namespace patina
