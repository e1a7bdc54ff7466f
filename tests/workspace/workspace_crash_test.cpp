// A save that is killed, or refused by the disk, at each of its steps in turn. The C functions that
// change a disk are replaced in this program by ones that count, so that no step is missed.
#include <cerrno>
#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include "core/error.h"
#include "workspace/workspace_support.h"

namespace {

enum class Fault { none, kill, refuse };
Fault injected = Fault::none;
int steps_left = -1; // until the fault; negative = never

// True if this call must fail.
bool step() {
  if (injected == Fault::none || steps_left-- != 0) return false;
  if (injected == Fault::kill) _exit(9);
  errno = ENOSPC;
  return true;
}

} // namespace

extern "C" {
ssize_t write(int fd, const void* bytes, size_t size) {
  if (step()) return -1;
  return syscall(SYS_write, fd, bytes, size);
}
// The machine does not fail here, only the program: flushing for real would take seconds.
int fsync(int) {
  return step() ? -1 : 0;
}
int rename(const char* from, const char* to) noexcept {
  return step() ? -1 : static_cast<int>(syscall(SYS_renameat, AT_FDCWD, from, AT_FDCWD, to));
}
int unlink(const char* path) noexcept {
  return step() ? -1 : static_cast<int>(syscall(SYS_unlinkat, AT_FDCWD, path, 0));
}
int remove(const char* path) noexcept {
  const int result = unlink(path);
  return result != 0 && errno == EISDIR ? rmdir(path) : result;
}
}

namespace patina {
namespace {

constexpr int kSaved = 0;
constexpr int kKilled = 9;
constexpr int kRefused = 10;

// How a child that saves with the fault at `at` ends.
int saveInChild(const Scene& scene, const std::filesystem::path& folder, Fault fault, int at) {
  const pid_t child = fork();
  if (child == 0) {
    injected = fault;
    steps_left = at;
    try {
      saveWorkspace(scene, folder);
    } catch (const Error&) {
      _exit(kRefused);
    }
    _exit(kSaved);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WEXITSTATUS(status);
}

class WorkspaceCrash : public WorkspaceTest {};

TEST_F(WorkspaceCrash, KilledAtAnyStepLeavesOldOrNewWhole) {
  const Scene old_scene = sceneWithObjects(0.05), new_scene = sceneWithObjects(0.08);
  int olds = 0, news = 0;
  for (int at = 0;; ++at) {
    saveWorkspace(old_scene, folder);
    const int end = saveInChild(new_scene, folder, Fault::kill, at);
    const Scene found = loadWorkspace(folder);
    const bool is_old = same(found, old_scene), is_new = same(found, new_scene);
    ASSERT_TRUE(is_old || is_new) << "killed at step " << at;
    // Once new, never old again at a later step.
    ASSERT_TRUE(is_new || news == 0) << "killed at step " << at;
    if (end == kSaved) {
      EXPECT_TRUE(is_new);
      break;
    }
    ASSERT_EQ(end, kKilled);
    ++(is_old ? olds : news);
  }
  // Two meshes (write, flush, rename, flush, rename), the folders, the manifest: a dozen at least;
  // fewer would mean that the counting functions were not called.
  EXPECT_GE(olds, 12);
  EXPECT_GE(news, 2);
  // What the killed saves left behind is gone after a whole one.
  saveWorkspace(new_scene, folder);
  EXPECT_EQ(meshFiles(), 2u);
}

TEST_F(WorkspaceCrash, RefusedAtAnyStepLeavesOldOrNewWhole) {
  const Scene old_scene = sceneWithObjects(0.05), new_scene = sceneWithObjects(0.08);
  int refused = 0;
  for (int at = 0; at < 40; ++at) {
    saveWorkspace(old_scene, folder);
    const int end = saveInChild(new_scene, folder, Fault::refuse, at);
    const Scene found = loadWorkspace(folder);
    if (end == kSaved) {
      ASSERT_TRUE(same(found, new_scene)) << "refused at step " << at;
    } else {
      ASSERT_EQ(end, kRefused);
      ASSERT_TRUE(same(found, old_scene) || same(found, new_scene)) << "refused at step " << at;
      ++refused;
    }
  }
  EXPECT_GE(refused, 12);
}

TEST_F(WorkspaceCrash, AFirstSaveThatIsKilledIsNotAWorkspace) {
  for (int at = 0;; ++at) {
    std::filesystem::remove_all(folder);
    const int end = saveInChild(sceneWithObjects(0.05), folder, Fault::kill, at);
    if (isWorkspace(folder)) {
      EXPECT_TRUE(same(loadWorkspace(folder), sceneWithObjects(0.05)));
    }
    if (end == kSaved) break;
  }
  EXPECT_TRUE(isWorkspace(folder));
}

} // namespace
} // namespace patina
