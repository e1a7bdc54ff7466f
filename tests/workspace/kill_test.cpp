// Programs that are killed at random moments while they paint and save.
#include <cstdlib>
#include <signal.h>
#include <sys/wait.h>

#include "workspace/child_process.h"
#include "workspace/workspace_support.h"

namespace patina {
namespace {

// Returns the last number that the child reported until its end, or `none`.
std::size_t lastReported(int pipe, std::string& text, std::size_t none) {
  char part[4096];
  for (ssize_t got; (got = ::read(pipe, part, sizeof part)) > 0;)
    text.append(part, static_cast<std::size_t>(got));
  const std::size_t end = text.rfind('\n');
  if (end == std::string::npos) return none;
  const std::size_t begin = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
  return std::stoul(text.substr(begin == std::string::npos ? 0 : begin + 1));
}

// The long form of docs/contributing.md: PATINA_KILLS=1000, then with real flushes on a real disk.
const char* longForm() {
  return std::getenv("PATINA_KILLS");
}

class KilledPainter : public WorkspaceTest {
 protected:
  KilledPainter()
      : WorkspaceTest(longForm() ? std::filesystem::path(testing::TempDir()) : fastFolder()) {}
};

TEST_F(KilledPainter, LosesNoReportedStroke) {
  const char* wanted = longForm();
  const int kills = wanted ? std::atoi(wanted) : 40;
  std::mt19937 random(static_cast<unsigned>(kills));
  std::size_t known = 0, in_progress = 0, reported_all = 0;
  for (int round = 0; round < kills; ++round) {
    if (round % 20 == 0) { // a history that grows without end only costs time
      std::filesystem::remove_all(folder);
      saveWorkspace(sceneWithObjects(0.01), folder);
      known = 0;
    }
    const auto seed = static_cast<unsigned>(random());
    const StrokesChild child = startStrokes(folder, seed, wanted != nullptr);
    std::string text;
    // Most kills come while it paints, a few while it opens the workspace.
    if (random() % 8 != 0) {
      char first = 0;
      ASSERT_EQ(::read(child.out, &first, 1), 1) << "the child did not start";
      text = first;
    }
    ::usleep(static_cast<useconds_t>(random() % 40000));
    ::kill(child.pid, SIGKILL);
    int status = 0;
    ::waitpid(child.pid, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << "round " << round << " ended by itself";
    const std::size_t reported = lastReported(child.out, text, known);
    ::close(child.out);

    OpenedWorkspace found;
    ASSERT_NO_THROW(found = openWorkspace(folder)) << "round " << round;
    ASSERT_GE(found.journal.size(), reported) << "round " << round;
    ASSERT_LE(found.journal.size(), reported + 1) << "round " << round;
    if (found.event > 0) {
      ASSERT_EQ(found.scene.haptics.stiffness, 100 + static_cast<double>(found.event));
    }
    for (const JournalEvent& event : found.journal)
      if (const auto* scene = std::get_if<StoredSceneEdit>(&event)) {
        ASSERT_NO_THROW(loadState(folder, scene->state));
      }
    reported_all += reported - known;
    in_progress += found.journal.size() - reported;
    known = found.journal.size();
  }
  RecordProperty("strokes", static_cast<int>(reported_all));
  // Kills before the first stroke would prove nothing.
  EXPECT_GT(reported_all, static_cast<std::size_t>(wanted ? kills / 2 : kills)); // real disks wait
  std::printf("%d kills, %zu records reported and kept, %zu more were on disk\n", kills,
              reported_all, in_progress);
}

} // namespace
} // namespace patina
