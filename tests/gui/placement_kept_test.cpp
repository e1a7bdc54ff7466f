// The window warns before a path's pose on the mesh is lost.
#include <cmath>

#include <QLineEdit>
#include <QMessageBox>

#include "acquisition/files/scan_tables.h"
#include "app/gui/aligning/align_desk.h"
#include "app/gui/scanning/scan_desk.h"
#include "core/progress.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "session/edit/editor.h"

namespace patina {
namespace {

std::vector<PathSample> circle() {
  std::vector<PathSample> path(200);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / 200;
    path[i].t = 0.01 * static_cast<double>(i);
    path[i].position = Vec3(0.02 * std::cos(angle), 0.02 * std::sin(angle), 0.05);
    path[i].sigma = 1e-5;
  }
  return path;
}

class PlacementKept : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 20), "ball.ply")));
    writePath(folder_ / "path.csv", circle());
    clickAction("desk_align");
    answerWithPath(folder_ / "path.csv");
    clickOn("align_open");
    ASSERT_TRUE(waitUntil([&] { return desk().alignment().isReady(); }, 10000));
    wait(1500);
  }
  AlignDesk& desk() { return *window_->findChild<AlignDesk*>(); }
  void lay() {
    click(*find<ValueRow>("align_z")->findChild<QLineEdit*>());
    type('a', kControl);
    type(QStringLiteral("12.5"));
    type(kEnter);
    ASSERT_TRUE(waitUntil([&] { return desk().alignment().done() > 0; }, 3000));
  }
  void answer(QMessageBox::StandardButton button) {
    whenAsked<QMessageBox>([this, button](QMessageBox& box) {
      asked_.push_back(box.objectName());
      words_ = box.text();
      click(*box.button(button));
    });
  }
  bool closes() {
    type('q', kControl);
    wait(1500);
    return !window_->isVisible();
  }

  QStringList asked_;
  QString words_;
};

TEST_F(PlacementKept, DoesNotAskAboutAnUnchangedPose) {
  EXPECT_TRUE(closes());
  EXPECT_TRUE(asked_.isEmpty());
}

TEST_F(PlacementKept, AsksAndNamesThePathOnCloseAndCancelContinues) {
  lay();
  answer(QMessageBox::Cancel);
  EXPECT_FALSE(closes());
  EXPECT_EQ(asked_, QStringList(QStringLiteral("unkept_placement")));
  EXPECT_TRUE(words_.contains(QStringLiteral("path.csv"))) << words_.toStdString();
  EXPECT_NEAR(desk().alignment().pose().translation().z(), 0.0125, 1e-9);
  answer(QMessageBox::Discard);
  EXPECT_TRUE(closes());
}

TEST_F(PlacementKept, DoesNotAskAboutAPoseSavedInAFile) {
  lay();
  answerWithPath(folder_ / "kept.csv");
  clickOn("align_keep");
  ASSERT_TRUE(waitUntil([&] { return std::filesystem::exists(folder_ / "kept.txt"); }, 10000));
  EXPECT_TRUE(closes());
}

TEST_F(PlacementKept, AsksBeforeAnotherSceneOpens) {
  lay();
  answer(QMessageBox::Cancel);
  const auto before = edits().scene();
  documents().openFile(QString::fromStdString(saved(icosphere(30, 8), "other.obj").string()));
  ASSERT_TRUE(waitUntil([&] { return !asked_.isEmpty(); }, 10000));
  wait(500);
  EXPECT_EQ(edits().scene(), before);
}

TEST_F(PlacementKept, AsksBeforeAnotherPathOpens) {
  lay();
  writePath(folder_ / "other.csv", desk().alignment().path());
  const auto openOther = [&] {
    asked_.clear();
    answerWithPath(folder_ / "other.csv");
    clickOn("align_open");
  };
  answer(QMessageBox::Cancel);
  openOther();
  ASSERT_TRUE(waitUntil([&] { return !asked_.isEmpty(); }, 10000));
  wait(300);
  EXPECT_EQ(desk().name(), QStringLiteral("path.csv"));
  EXPECT_NEAR(desk().alignment().pose().translation().z(), 0.0125, 1e-9);
  answer(QMessageBox::Discard);
  openOther();
  ASSERT_TRUE(waitUntil([&] { return desk().name() == QStringLiteral("other.csv"); }, 10000));
  EXPECT_EQ(asked_.size(), 1);
  EXPECT_TRUE(desk().isSaved());
}

TEST_F(PlacementKept, AsksBeforeTheScanIsFilteredAgain) {
  lay();
  answer(QMessageBox::Cancel);
  emit window_->findChild<ScanDesk*>()->pathMade(QStringLiteral("stroke"),
                                                 desk().alignment().path());
  EXPECT_EQ(asked_.size(), 1);
  EXPECT_EQ(desk().name(), QStringLiteral("path.csv"));
}

TEST_F(PlacementKept, KeepsThePoseIfTheSceneIsEdited) {
  lay();
  const Pose place = desk().alignment().pose();
  const auto target = desk().alignment().target();
  const auto distance = [&] {
    return residualsOf(*desk().alignment().target(), desk().alignment().points(), place).mean;
  };
  const double before = distance();
  SceneObject object;
  object.name = "block";
  object.mesh = std::make_shared<const TriangleMesh>(box({0.05, 0.05, 0.07}, 4));
  edits().addObjects({object}, [](const EditOutcome&) {});
  ASSERT_TRUE(waitUntil([&] { return desk().alignment().target() != target; }, 20000));
  EXPECT_EQ(desk().alignment().pose().matrix(), place.matrix());
  EXPECT_FALSE(desk().isSaved());
  EXPECT_EQ(desk().alignment().done(), 1U);
  EXPECT_GT(std::abs(distance() - before), 1e-4) << "from the present surface";
  const QString words = find<QLabel>("align_error")->text();
  edits().thread().undo();
  ASSERT_TRUE(waitUntil([&] { return std::abs(distance() - before) < 1e-9; }, 20000));
  wait(100);
  EXPECT_NE(find<QLabel>("align_error")->text(), words);
  EXPECT_EQ(desk().alignment().pose().matrix(), place.matrix());
}

TEST_F(PlacementKept, CountsAsSavedOnceTheWorkspaceHasIt) {
  lay();
  find<QPushButton>("align_store")->click();
  EXPECT_FALSE(desk().isSaved()) << "the edit is not done yet";
  answer(QMessageBox::Discard); // discards the edits
  EXPECT_TRUE(closes()) << "it is waited for";
  EXPECT_EQ(asked_, QStringList(QStringLiteral("unsaved_edits")));
  EXPECT_TRUE(desk().isSaved());
}

TEST_F(PlacementKept, CountsAsUnsavedIfTheWorkspaceRefusesIt) {
  lay();
  SceneScan other = alignedScan("path.csv", desk().alignment());
  std::vector<PathSample> path = desk().alignment().path();
  path[0].position.x() += 1e-3;
  other.files["path.csv"] = std::make_shared<const std::string>(pathText(path));
  edits().thread().apply("attach", [other](const CompiledScene& now) {
    return std::make_shared<const Scene>(withScan(now.scene, other));
  });
  ASSERT_TRUE(waitUntil([&] { return !edits().scene()->scene.scans.empty(); }, 10000));
  bool told = false;
  whenAsked<QDialog>([&](QDialog& dialog) {
    told = true;
    dialog.reject();
  });
  clickOn("align_store");
  ASSERT_TRUE(waitUntil([&] { return told; }, 10000));
  EXPECT_FALSE(desk().isSaved());
}

class PlacementOpened : public DrivenWindow {};

TEST_F(PlacementOpened, IsShownAtTheWorkspacesPose) {
  const auto ball = std::make_shared<const TriangleMesh>(icosphere(0.03, 20));
  const Pose place(Eigen::Translation3d(0.001, -0.002, 0.0125));
  Alignment laid;
  laid.setMesh(ball);
  laid.setPath(circle());
  laid.setPose(place);
  Scene scene;
  scene.objects.push_back({"ball", ball, Pose::Identity(), {}});
  scene.scans = {alignedScan("stroke", laid)};
  Progress progress;
  Editor(scene, progress).saveAs(folder_ / "kept.patina");

  ASSERT_TRUE(open(folder_ / "kept.patina"));
  const auto& desk = *window_->findChild<AlignDesk*>();
  wait(300);
  EXPECT_TRUE(desk.alignment().path().empty()) << "the desk is not open yet";
  clickAction("desk_align");
  ASSERT_TRUE(waitUntil([&] { return desk.alignment().isReady(); }, 10000));
  EXPECT_EQ(desk.name(), QStringLiteral("stroke"));
  EXPECT_TRUE(desk.alignment().pose().isApprox(place, 1e-12));
  EXPECT_TRUE(desk.isSaved());
}

} // namespace
} // namespace patina
