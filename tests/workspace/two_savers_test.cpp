// Programs that save into one folder at the same time.
#include <cstdio>
#include <sys/wait.h>
#include <unistd.h>

#include "workspace/workspace_support.h"

namespace patina {
namespace {

constexpr int kTimes = 60;

template <typename Work> pid_t inAnotherProcess(const Work& work) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  try {
    work();
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    ::_exit(2);
  }
  ::_exit(0);
}

int endOf(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(WorkspaceTest, SimultaneousSavesLeaveOneOrTheOther) {
  const Scene one = sceneWithObjects(0.05), other = sceneWithObjects(0.08);
  for (int i = 0; i < kTimes; ++i) {
    std::filesystem::remove_all(folder);
    const pid_t first = inAnotherProcess([&] { saveWorkspace(one, folder); });
    const pid_t second = inAnotherProcess([&] { saveWorkspace(other, folder); });
    EXPECT_EQ(endOf(first), 0);
    EXPECT_EQ(endOf(second), 0);
    OpenedWorkspace found;
    ASSERT_NO_THROW(found = openWorkspace(folder)) << i;
    ASSERT_TRUE(same(found.scene, one) || same(found.scene, other)) << i;
    ASSERT_TRUE(same(loadState(folder, found.states.front().file), found.scene)) << i;
  }
}

TEST_F(WorkspaceTest, RefusesAHistoryWithoutItsScenes) {
  const Scene scene = sceneWithObjects(0.05);
  saveWorkspace(scene, folder);
  const std::vector<StoredState> states{{0, storeState(scene, 0, folder)}};
  const std::string edit = storeState(sceneWithObjects(0.08), 1, folder);
  std::filesystem::remove(folder / edit);
  EXPECT_THROW(saveWorkspace(scene, 1, states, {StoredSceneEdit{"change", edit}}, folder),
               FileError);
  EXPECT_TRUE(openWorkspace(folder).journal.empty());
}

} // namespace
} // namespace patina
