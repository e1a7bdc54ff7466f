// Unsaved marks and questions if a folder does not belong to the window.
#include "core/progress.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "session/edit/editor.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

class SaveState : public DrivenWindow {
 protected:
  bool marked(bool wanted) {
    return waitUntil([&] { return window_->isWindowModified() == wanted; }, 5000);
  }
  bool editsAre(std::size_t count, std::size_t done) {
    return waitUntil(
        [&] { return edits().status().edits.size() == count && edits().status().done == done; },
        10000);
  }
};

// A part of 1 mm causes a warning too. The notice must still name the restored edits.
TEST_F(SaveState, MarksEditsOfAKilledProgramAsUnsaved) {
  Scene scene;
  scene.objects.push_back({"plate",
                           std::make_shared<const TriangleMesh>(box({0.06, 0.06, 0.001}, 8)),
                           Pose::Identity(),
                           {}});
  Progress progress;
  Editor killed(scene, progress);
  killed.saveAs(folder_ / "open.patina");
  killed.apply(ValueEdit{{{"stiffness", "700"}}}, progress);
  std::filesystem::copy(folder_ / "open.patina", folder_ / "left.patina",
                        std::filesystem::copy_options::recursive);
  ASSERT_TRUE(open(folder_ / "left.patina"));
  EXPECT_TRUE(marked(true));
  EXPECT_EQ(edits().scene()->scene.haptics.stiffness, 700);
  EXPECT_TRUE(find<QLabel>("notice")->text().contains(QStringLiteral("are restored")))
      << find<QLabel>("notice")->text().toStdString();
}

TEST_F(SaveState, MarksEditsInAWorkspaceOpenInAnotherProgramAsUnsaved) {
  Scene scene;
  scene.objects.push_back(
      {"ball", std::make_shared<const TriangleMesh>(icosphere(0.03, 12)), Pose::Identity(), {}});
  Progress progress;
  Editor other(scene, progress);
  other.apply(ValueEdit{{{"stiffness", "700"}}}, progress);
  const auto folder = folder_ / "pot.patina";
  other.saveAs(folder);

  ASSERT_TRUE(open(folder));
  wait(300);
  EXPECT_EQ(edits().status().edits.size(), 1U);
  EXPECT_FALSE(window_->isWindowModified()) << "nothing was edited";
  EXPECT_TRUE(find<QLabel>("notice")->text().contains(QStringLiteral("not saved")));
  type('z', kControl);
  EXPECT_TRUE(editsAre(1, 0));
  EXPECT_TRUE(marked(true));
  type('y', kControl);
  EXPECT_TRUE(editsAre(1, 1));
  EXPECT_TRUE(marked(false));
  setRow("stiffness", 250);
  EXPECT_TRUE(editsAre(2, 2));
  EXPECT_TRUE(marked(true));

  answerWithPath(folder_ / "mine.patina");
  type('s', kControl);
  ASSERT_TRUE(waitUntil([&] { return isWorkspace(folder_ / "mine.patina"); }, 20000));
  EXPECT_TRUE(marked(false));
  EXPECT_TRUE(window_->windowTitle().startsWith(QStringLiteral("mine.patina")));
  EXPECT_EQ(loadWorkspace(folder).haptics.stiffness, 700) << "foreign files stay";
  EXPECT_EQ(loadWorkspace(folder_ / "mine.patina").haptics.stiffness, 250);
  setRow("stiffness", 300);
  EXPECT_TRUE(editsAre(3, 3));
  EXPECT_TRUE(marked(true));
  type('s', kControl);
  EXPECT_TRUE(marked(false)) << "the window owns it now";
  EXPECT_EQ(loadWorkspace(folder_ / "mine.patina").haptics.stiffness, 300);
  EXPECT_TRUE(window_->close()) << "there is nothing to ask";
}

// The edit's thread is idle before the window is notified.
TEST_F(SaveState, HandlesFinishedEditsBeforeClosingAsks) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 8), "ball.ply")));
  wait(300);
  SceneObject object;
  object.name = "block";
  object.mesh = std::make_shared<const TriangleMesh>(box({0.01, 0.01, 0.01}, 4));
  bool heard = false;
  edits().addObjects({object}, [&](const EditOutcome&) { heard = true; });
  for (int i = 0; i < 2000 && edits().thread().busy(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_FALSE(edits().thread().busy());
  ASSERT_FALSE(heard);
  edits().waitForEdits();
  EXPECT_TRUE(heard);
  EXPECT_TRUE(edits().unsaved());
}

} // namespace
} // namespace patina
