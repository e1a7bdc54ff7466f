// Desks: the tools and panels of each, and that the user's arrangement stays.
#include <fstream>

#include <QScreen>
#include <QSettings>
#include <QSplitter>

#include "app/gui/control/desk_controller.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"

namespace patina {
namespace {

class Desks : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
    wait(300);
  }
  Desk desk() { return window_->controllers().desks.desk(); }
  void go(const QString& name) { clickAction("desk_" + name); }
  QWidget& column() { return *find<QWidget>("column"); }
  QWidget& drawer() { return *find<QWidget>("drawer"); }
  void saveScreen(const char* name) {
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      window_->grab().save(QString::fromUtf8(folder) + "/" + name + ".png");
  }
};

TEST_F(Desks, FeelLeavesRoomForThePicture) {
  saveScreen("feel");
  EXPECT_EQ(desk(), Desk::feel);
  EXPECT_GE(view().width(), 930);
  EXPECT_GE(view().height(), 680);
}

TEST_F(Desks, BarSwitchesDesksAndKeepsTools) {
  EXPECT_FALSE(find<BrushPanel>()->isVisible());
  go("paint");
  saveScreen("paint");
  EXPECT_EQ(desk(), Desk::paint);
  EXPECT_TRUE(find<BrushPanel>()->isVisible());
  EXPECT_TRUE(find<ToolBar>()->choice() == (ToolChoice{InteractionMode::paint, Tool::color}));
  go("analyse");
  wait(300);
  saveScreen("analyse");
  EXPECT_TRUE(find<DisplayPanel>()->isVisible());
  EXPECT_TRUE(find<ForcePlot>()->isVisible());
  EXPECT_TRUE(find<ToolBar>()->choice() == (ToolChoice{InteractionMode::press, {}}));
  type(QStringLiteral("h")); // relief, a tool of Paint
  EXPECT_EQ(desk(), Desk::paint);
  EXPECT_TRUE(find<ReliefPanel>()->isVisible());
  type('4', kControl);
  EXPECT_EQ(desk(), Desk::feel);
  EXPECT_FALSE(find<ReliefPanel>()->isVisible());
  type('5', kControl);
  EXPECT_TRUE(find<ToolBar>()->choice() == (ToolChoice{InteractionMode::paint, Tool::relief}));
}

TEST_F(Desks, TabsShowTheirCardsAndFoldAtASecondClick) {
  clickOn("tab_device");
  EXPECT_TRUE(find<DevicePanel>()->isVisible());
  EXPECT_FALSE(find<HapticsPanel>()->isVisible());
  const int wide = view().width();
  clickOn("tab_device");
  EXPECT_FALSE(find<DevicePanel>()->isVisible());
  EXPECT_LT(column().width(), 60);
  EXPECT_GT(view().width(), wide + 200);
  saveScreen("folded");
  clickOn("tab_show");
  EXPECT_TRUE(find<DisplayPanel>()->isVisible());
  EXPECT_EQ(view().width(), wide);
  const int high = view().height();
  clickOn("page_energy");
  EXPECT_TRUE(find<EnergyPlot>()->isVisible());
  EXPECT_LT(view().height(), high - 80);
  clickOn("page_energy");
  EXPECT_FALSE(find<EnergyPlot>()->isVisible());
  EXPECT_EQ(view().height(), high);
}

TEST_F(Desks, ColumnWidensByItsEdgeUpToItsLimit) {
  QWidget& handle = *find<QSplitter>("across")->handle(1);
  const QPoint edge = handle.mapToGlobal(handle.rect().center());
  drag(edge, edge - QPoint(100, 0));
  EXPECT_NEAR(column().width(), 400, 3);
  drag(handle.mapToGlobal(handle.rect().center()), QPoint(300, 300));
  EXPECT_EQ(column().width(), 480);
}

TEST_F(Desks, NarrowWindowFoldsTheColumnToIconsUntilAClick) {
  takeSize(1024, 700);
  EXPECT_LT(column().width(), 60);
  saveScreen("narrow");
  clickOn("tab_surface");
  EXPECT_GE(column().width(), 300);
  EXPECT_TRUE(find<HapticsPanel>()->isVisible());
  takeSize(1280, 800);
  EXPECT_GE(column().width(), 300);
}

TEST_F(Desks, StatusLineHasRoomForItsStages) {
  addProperty("Friction");
  addProperty("Damping");
  const auto* stages = dynamic_cast<ElidedLabel*>(find<QLabel>("stages"));
  ASSERT_NE(stages, nullptr);
  ASSERT_TRUE(waitUntil([&] { return stages->text().contains("damp"); }, 5000));
  wait(100);
  saveScreen("stages");
  EXPECT_FALSE(stages->elides()) << stages->text().toStdString();
}

TEST_F(Desks, MessagesDoNotMoveThePicture) {
  const QRect before = view().geometry();
  const QPoint at = view().mapToGlobal(QPoint());
  emit documents().notified({QStringLiteral("The mesh is open at 12 edges"), true});
  wait(50);
  EXPECT_TRUE(find<QLabel>("notice")->isVisible());
  EXPECT_EQ(view().geometry(), before);
  EXPECT_EQ(view().mapToGlobal(QPoint()), at);
  clickOn("dismiss");
  EXPECT_FALSE(find<QLabel>("notice")->isVisible());
  clickOn("page_messages");
  emit documents().notified({QStringLiteral("It was read"), true});
  wait(50);
  EXPECT_FALSE(find<QLabel>("notice")->isVisible()) << "it is in the list that is open";
  EXPECT_TRUE(find<MessagePanel>()
                  ->item(find<MessagePanel>()->count() - 2)
                  ->text()
                  .contains(QStringLiteral("12 edges")));
}

TEST_F(Desks, RestoreSizesTabsAndTheDeskAtTheNextStart) {
  window_->restorePlace(); // nothing is kept yet
  takeSize(1340, 820);
  go("analyse");
  clickOn("tab_object");
  clickOn("page_energy");
  QWidget& handle = *find<QSplitter>("across")->handle(1);
  const QPoint edge = handle.mapToGlobal(handle.rect().center());
  drag(edge, edge - QPoint(60, 0));
  const int wide = column().width();
  go("feel");
  clickOn("tab_device");
  clickOn("tab_device"); // folds
  go("analyse");
  documents().setInteractive(false);
  ASSERT_TRUE(window_->close());
  window_ = std::make_unique<MainWindow>();
  window_->restorePlace();
  window_->show();
  ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
  EXPECT_EQ(window_->size(), QSize(1340, 820));
  EXPECT_EQ(desk(), Desk::analyse);
  EXPECT_NEAR(column().width(), wide, 1);
  EXPECT_TRUE(find<ObjectPanel>()->isVisible());
  EXPECT_TRUE(find<EnergyPlot>()->isVisible());
  go("feel");
  EXPECT_LT(column().width(), 60);
}

TEST_F(Desks, ShowAMeshThatIsOpened) {
  const auto ball = saved(icosphere(20, 12), "ball.obj");
  const auto openBall = [&] {
    bool ready = false;
    const auto connection =
        QObject::connect(window_.get(), &MainWindow::sceneReady, [&] { ready = true; });
    answerWithPath(ball);
    type('o', kControl);
    EXPECT_TRUE(waitUntil([&] { return ready; }, 20000));
    QObject::disconnect(connection);
  };
  for (const char* name : {"texture", "scan", "align"}) {
    go(name);
    openBall();
    EXPECT_EQ(desk(), Desk::feel) << name;
    EXPECT_TRUE(view().isVisible()) << name;
  }
  go("texture");
  clickOn("tab_library");
  openBall();
  EXPECT_EQ(desk(), Desk::texture) << "it is visible there";
}

TEST_F(Desks, ShowAWorkspaceThatIsAlreadyOpen) {
  saving().saveTo(QString::fromStdString((folder_ / "work").string()));
  ASSERT_TRUE(waitUntil([&] { return edits().status().folder.has_value(); }, 20000));
  go("texture");
  documents().open(requestFor(folder_ / "work"));
  EXPECT_TRUE(waitUntil([&] { return desk() == Desk::feel; }, 5000));
}

TEST_F(Desks, KeepADeskChosenWhileAMeshLoads) {
  bool ready = false;
  QObject::connect(window_.get(), &MainWindow::sceneReady, [&] { ready = true; });
  documents().open(requestFor(saved(icosphere(0.02, 12), "ball.obj")));
  window_->controllers().desks.choose(Desk::texture);
  ASSERT_TRUE(waitUntil([&] { return ready; }, 20000));
  EXPECT_EQ(desk(), Desk::texture);
}

TEST_F(Desks, StayIfLoadingFailsOrIsCancelled) {
  go("texture");
  std::ofstream(folder_ / "bad.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999\n";
  bool failed = false, cancelled = false, previewed = false;
  QObject::connect(&documents(), &DocumentController::failed, [&] { failed = true; });
  documents().open(requestFor(folder_ / "bad.obj"));
  ASSERT_TRUE(waitUntil([&] { return failed; }, 20000));
  EXPECT_EQ(desk(), Desk::texture);
  wait(200);
  if (QWidget* box = QApplication::activeModalWidget()) box->close();
  // A load that is cancelled after its preview leaves the desk, too.
  QObject::connect(&documents(), &DocumentController::cancelled, [&] { cancelled = true; });
  QObject::connect(&documents(), &DocumentController::previewed, window_.get(), [&] {
    previewed = true;
    EXPECT_EQ(desk(), Desk::feel) << "its mesh is visible";
    documents().cancel();
  });
  documents().open(requestFor(saved(icosphere(0.02, 40), "ball.obj")));
  ASSERT_TRUE(waitUntil([&] { return cancelled; }, 20000));
  EXPECT_TRUE(previewed);
  EXPECT_EQ(desk(), Desk::texture);
}

TEST_F(Desks, StartAtThePageIfTheDeskHasNoPicture) {
  for (const Desk last : {Desk::scan, Desk::texture, Desk::align}) {
    QSettings().setValue(QStringLiteral("window/desk"), static_cast<int>(last));
    QSettings().setValue(QStringLiteral("desks/texture/tab"), static_cast<int>(Tab::library));
    window_ = std::make_unique<MainWindow>();
    window_->restorePlace();
    window_->show();
    EXPECT_TRUE(waitUntil([&] { return find<WelcomePage>()->isVisible(); }, 3000))
        << static_cast<int>(last);
  }
}

TEST_F(Desks, RestoreANarrowWindowsWidth) {
  for (const DeskRow& row : deskRows()) {
    QSettings().setValue(QStringLiteral("window/size"), QSize(1012, 656));
    QSettings().setValue(QStringLiteral("window/desk"), static_cast<int>(row.desk));
    window_ = std::make_unique<MainWindow>();
    window_->restorePlace();
    window_->show();
    wait(300);
    EXPECT_EQ(window_->width(), 1012) << row.name;
    window_->controllers().desks.choose(row.desk);
    window_->controllers().desks.foldSidePanel(false);
    wait(300);
    EXPECT_EQ(window_->width(), 1012) << row.name;
  }
}

TEST_F(Desks, FitALargerWindowOnThisScreenWithItsFrame) {
  QSettings().setValue(QStringLiteral("window/size"), QSize(6000, 4000));
  window_ = std::make_unique<MainWindow>();
  window_->restorePlace();
  window_->show();
  ASSERT_TRUE(waitUntil([&] { return window_->frameGeometry() != window_->geometry(); }, 3000));
  const QRect screen = window_->screen()->availableGeometry();
  EXPECT_TRUE(waitUntil([&] { return screen.contains(window_->frameGeometry()); }, 3000))
      << window_->frameGeometry().bottom() << " of " << screen.bottom();
  EXPECT_GT(window_->height(), screen.height() - 60);
}

} // namespace
} // namespace patina
