// A bar says that edits do not reach the scene's folder, and offers another one.
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>

#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "session/edit/editor.h"
#include "support/small_disk.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class Storage : public DrivenWindow {
 protected:
  QWidget* bar() { return find<QWidget>("storage_bar"); }
  QString words() { return bar()->findChild<QLabel*>()->text(); }
  fs::path workspace() const { return folder_ / "cup.patina"; }

  void saveElsewhere(const fs::path& folder) {
    answerWithPath(folder);
    clickOn("save_elsewhere");
    EXPECT_TRUE(waitUntil([&] { return edits().status().folder == folder; }, 20000));
    EXPECT_TRUE(waitUntil([&] { return !bar()->isVisible(); }, 5000));
  }
  void stroke() {
    drag(inView({-50, 0}), inView({50, 0}), 1, 10);
    wait(300);
  }
};

TEST_F(Storage, WorkspaceThatIsOpenElsewhereShowsALastingBar) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
  saving().saveTo(QString::fromStdString(workspace().string()));
  EXPECT_FALSE(bar()->isVisible());
  ASSERT_TRUE(open(saved(icosphere(0.03, 8), "other.obj")));
  Progress progress;
  const auto elsewhere = Editor::open(workspace(), {}, progress);
  ASSERT_TRUE(open(workspace()));
  ASSERT_TRUE(waitUntil([&] { return bar()->isVisible(); }, 5000));
  EXPECT_TRUE(words().contains(QStringLiteral("not saved in this folder")))
      << words().toStdString();
  EXPECT_TRUE(words().contains(QStringLiteral("another program"))) << words().toStdString();
  setRow("stiffness", 321);
  ASSERT_TRUE(waitUntil([&] { return edits().status().edits.size() == 1; }, 20000));
  wait(3000);
  EXPECT_TRUE(bar()->isVisible()) << "it lasts";
  saveElsewhere(folder_ / "mine.patina");
  EXPECT_EQ(loadWorkspace(folder_ / "mine.patina").haptics.stiffness, 321);
}

TEST_F(Storage, BarGoesWithItsScene) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
  saving().saveTo(QString::fromStdString(workspace().string()));
  ASSERT_TRUE(open(saved(icosphere(0.03, 8), "other.obj")));
  Progress progress;
  const auto elsewhere = Editor::open(workspace(), {}, progress);
  ASSERT_TRUE(open(workspace()));
  ASSERT_TRUE(waitUntil([&] { return bar()->isVisible(); }, 5000));
  ASSERT_TRUE(open(folder_ / "other.obj"));
  EXPECT_TRUE(waitUntil([&] { return !bar()->isVisible(); }, 5000));
}

TEST_F(Storage, FullDiskIsOfferedAnotherFolderOnceForManyStrokes) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
  saving().saveTo(QString::fromStdString(workspace().string()));
  trigger("tool_color");
  wait(300);
  stroke();
  ASSERT_TRUE(waitUntil([&] { return edits().status().edits.size() == 1; }, 20000));
  std::uintmax_t journal = 0;
  for (const auto& entry : fs::directory_iterator(workspace()))
    if (entry.path().extension() == ".jsonl") journal = entry.file_size();
  int dialogs = 0;
  QTimer watch;
  QObject::connect(&watch, &QTimer::timeout, [&] {
    if (auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget()))
      ++dialogs, box->reject();
  });
  watch.start(50);
  {
    const test::SmallDisk full(journal);
    for (int i = 0; i < 4; ++i) {
      stroke();
      EXPECT_TRUE(waitUntil([&] { return bar()->isVisible(); }, 10000)) << "stroke " << i;
    }
    EXPECT_TRUE(words().contains(QStringLiteral("written"))) << words().toStdString();
    EXPECT_EQ(edits().status().edits.size(), 1U) << "what failed has not happened";
  }
  EXPECT_EQ(dialogs, 0) << "a stroke opens none";
  watch.stop();
  saveElsewhere(folder_ / "roomy.patina");
  stroke();
  EXPECT_TRUE(waitUntil([&] { return edits().status().edits.size() == 2; }, 20000));
  EXPECT_FALSE(bar()->isVisible());
}

TEST_F(Storage, BarGoesOnceTheDiskHasRoomAgain) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
  saving().saveTo(QString::fromStdString(workspace().string()));
  trigger("tool_color");
  wait(300);
  {
    const test::SmallDisk full(1);
    stroke();
    ASSERT_TRUE(waitUntil([&] { return bar()->isVisible(); }, 10000));
  }
  stroke();
  EXPECT_TRUE(waitUntil([&] { return !bar()->isVisible(); }, 10000));
  EXPECT_EQ(edits().status().edits.size(), 1U);
}

} // namespace
} // namespace patina
