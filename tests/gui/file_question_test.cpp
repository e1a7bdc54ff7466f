// Open and Save As treat a workspace's folder as a file.
#include <fstream>

#include <QFileDialog>
#include <QLineEdit>
#include <QListView>

#include "app/gui/loading/workspace_file_dialog.h"
#include "app/gui/scanning/scan_desk.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

class FileQuestions : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 12), "sphere.obj")));
    saving().saveTo(text(folder_ / "sphere.patina"));
  }
  static QString text(const std::filesystem::path& path) {
    return QString::fromStdString(path.string());
  }
  WorkspaceFileDialog* question() {
    WorkspaceFileDialog* found = nullptr;
    waitUntil(
        [&] { return (found = find<WorkspaceFileDialog>()) != nullptr && found->isVisible(); },
        5000);
    wait(200);
    return found;
  }
  void enter(WorkspaceFileDialog& dialog, const QString& name) {
    dialog.findChild<QLineEdit*>()->setText(name);
    dialog.findChild<QLineEdit*>()->setFocus();
    wait(100);
    type(kEnter);
  }
};

TEST_F(FileQuestions, DoubleClickOpensAWorkspace) {
  ASSERT_TRUE(open(folder_ / "sphere.obj"));
  EXPECT_FALSE(edits().status().folder.has_value());
  type('o', kControl);
  WorkspaceFileDialog* dialog = question();
  ASSERT_NE(dialog, nullptr);
  dialog->setDirectory(text(folder_));
  wait(500);
  auto* list = dialog->findChild<QListView*>("listView");
  ASSERT_NE(list, nullptr);
  QModelIndex row;
  ASSERT_TRUE(waitUntil(
      [&] {
        for (int i = 0; i < list->model()->rowCount(list->rootIndex()); ++i) {
          const QModelIndex index = list->model()->index(i, 0, list->rootIndex());
          if (index.data().toString() == QStringLiteral("sphere.patina")) row = index;
        }
        return row.isValid();
      },
      5000));
  doubleClickAt(list->viewport()->mapToGlobal(list->visualRect(row).center()));
  EXPECT_TRUE(waitUntil([&] { return edits().status().folder.has_value(); }, 10000));
}

TEST_F(FileQuestions, NameAndEnterOpenAWorkspace) {
  ASSERT_TRUE(open(folder_ / "sphere.obj"));
  type('o', kControl);
  WorkspaceFileDialog* dialog = question();
  ASSERT_NE(dialog, nullptr);
  enter(*dialog, text(folder_ / "sphere.patina"));
  EXPECT_TRUE(waitUntil([&] { return edits().status().folder.has_value(); }, 10000));
}

TEST_F(FileQuestions, BeginWhereTheLastOneEnded) {
  const auto other = folder_ / "other";
  std::filesystem::create_directory(other);
  writeMesh(other / "ball.obj", icosphere(30, 12)); // in mm
  type('o', kControl);
  WorkspaceFileDialog* dialog = question();
  ASSERT_NE(dialog, nullptr);
  enter(*dialog, text(other / "ball.obj"));
  ASSERT_TRUE(waitUntil([&] { return !edits().status().folder.has_value(); }, 10000));
  wait(300);
  type('o', kControl);
  dialog = question();
  ASSERT_NE(dialog, nullptr);
  EXPECT_EQ(dialog->directory().path(), text(other));
  type(kEscape);
}

TEST_F(FileQuestions, TakeTheUnitAndTheUpAxisOfAMesh) {
  saved(box(Vec3(2, 4, 6)), "plank.obj");
  type('o', kControl);
  WorkspaceFileDialog* dialog = question();
  ASSERT_NE(dialog, nullptr);
  auto* unit = dialog->findChild<QComboBox*>("open_unit");
  constexpr std::uint32_t kDown = 0xff54;
  click(*unit);
  wait(200);
  for (int i = 0; i < 4; ++i) type(kDown); // inches
  type(kEnter);
  click(*dialog->findChild<QCheckBox*>("open_y_up"));
  enter(*dialog, text(folder_ / "plank.obj"));
  ASSERT_TRUE(waitUntil([&] { return edits().scene()->mesh->triangles.size() == 12; }, 10000));
  const Vec3 sides = bounds(*edits().scene()->mesh).sizes();
  EXPECT_NEAR((sides - 0.0254 * Vec3(2, 6, 4)).norm(), 0, 1e-9) << "y is up";
}

TEST_F(FileQuestions, NameAndEnterOpenAScanFolder) {
  std::filesystem::create_directory(folder_ / "scan");
  std::ofstream(folder_ / "scan" / "poses.tum") << "0 0 0 0.5 0 0 0 1\n0.1 0 0 0.5 0 0 0 1\n";
  type('o', kControl);
  WorkspaceFileDialog* dialog = question();
  ASSERT_NE(dialog, nullptr);
  enter(*dialog, text(folder_ / "scan"));
  const auto& scan = window_->findChild<ScanDesk*>()->scan();
  EXPECT_TRUE(waitUntil([&] { return scan.files() != nullptr; }, 10000));
}

TEST_F(FileQuestions, SaveAsSuggestsAFreeNameNextToTheOpenFile) {
  whenThere([this] { return find<WorkspaceFileDialog>(); },
            [this](WorkspaceFileDialog& dialog) {
              EXPECT_EQ(dialog.directory().path(), text(folder_));
              EXPECT_EQ(dialog.selectedFiles().front(), text(folder_ / "sphere-2.patina"));
              type(kEnter);
            });
  EXPECT_TRUE(saving().saveDialog());
  EXPECT_TRUE(isWorkspace(folder_ / "sphere-2.patina"));
  EXPECT_EQ(saving().name(), QStringLiteral("sphere-2.patina"));
}

TEST_F(FileQuestions, PutNoWorkspaceIntoAnother) {
  whenThere([this] { return find<WorkspaceFileDialog>(); },
            [this](WorkspaceFileDialog& dialog) {
              enter(dialog, text(folder_ / "sphere.patina" / "inner.patina"));
            });
  EXPECT_FALSE(saving().saveDialog());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "sphere.patina" / "inner.patina"));
}

} // namespace
} // namespace patina
