// A user comes from a scan to a touched texture by the pointer alone.
#include <QMenu>

#include "app/gui/scanning/scan_desk.h"
#include "app/gui/texturing/texture_desk.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"

namespace patina {
namespace {

class TextureDeskTest : public DrivenWindow {
 protected:
  TextureDesk& desk() { return *window_->findChild<TextureDesk*>(); }
  QString found(const QString& step) { return find<QLabel>("found_" + step)->text(); }
  bool rest() {
    return waitUntil([&] { return !desk().work(); }, 240000);
  }
  void keepPicture(const QString& name) {
    wait(400);
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      window_->grab().save(QStringLiteral("%1/%2.png").arg(QString::fromUtf8(folder), name));
  }
};

TEST_F(TextureDeskTest, TakesAScanToContactByItsButtons) {
  EXPECT_EQ(find<ScanView>("texture_view"), nullptr); // an absent scan costs nothing
  clickAction("desk_texture");
  EXPECT_FALSE(find<QWidget>("page_profile")->isVisible());
  clickOn("next_step");
  ASSERT_TRUE(desk().work());
  EXPECT_FALSE(find<QPushButton>("next_step")->isEnabled());
  ASSERT_TRUE(rest());
  EXPECT_TRUE(found("scan").contains(QStringLiteral("4 scans"))) << found("scan").toStdString();
  clickOn("next_step");
  ASSERT_TRUE(rest());
  EXPECT_TRUE(found("track").contains(QStringLiteral("poses")));
  // The desk Scan shows frames and markers of each scan.
  auto* look = find<QPushButton>("look_at_scan");
  ASSERT_EQ(look->menu()->actions().size(), 4);
  whenThere([&] { return look->menu(); },
            [this](QMenu& menu) {
              release();
              choose(menu, menu.actions()[1]->text());
            });
  clickOn("look_at_scan");
  auto* scan = window_->findChild<ScanDesk*>();
  ASSERT_TRUE(
      waitUntil([&] { return scan->isOpen() && scan->centralViews()->isVisible(); }, 60000));
  EXPECT_FALSE(scan->scan().files()->frames.empty());
  EXPECT_FALSE(scan->scan().files()->poses.empty());
  keepPicture("texture_frames");
  clickAction("desk_texture");
  clickOn("all_steps");
  ASSERT_TRUE(waitUntil([&] { return find<QPushButton>("feel_demo")->isVisible(); }, 240000));
  ASSERT_TRUE(rest());
  keepPicture("texture_done");
  EXPECT_TRUE(found("register").contains(QStringLiteral("registration: ")))
      << found("register").toStdString();
  EXPECT_TRUE(found("feel").contains(QStringLiteral("variation of the force")));
  // The textured faces and the paths are in the picture.
  ASSERT_TRUE(find<ScanView>("texture_view")->isVisible());
  const QImage picture = find<ScanView>("texture_view")->grabFramebuffer();
  int faces = 0, tube = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = picture.width() / 8; x < 7 * picture.width() / 8; ++x) {
      const QColor color = picture.pixelColor(x, y);
      faces += color.red() > color.blue() + 60;
      tube += color.blue() > color.red() + 40;
    }
  EXPECT_GT(faces, 300);
  EXPECT_GT(tube, 200);
  // Another material is another plot.
  auto* choice = find<QComboBox>("texture_choice");
  ASSERT_TRUE(choice->isVisible());
  ASSERT_EQ(choice->count(), 3);
  auto* plot = find<PlotWidget>("profile_plot");
  const QImage before = plot->grab().toImage();
  choice->setFocus();
  constexpr std::uint32_t kAway = 0xff54;
  type(kAway);
  wait(100);
  EXPECT_EQ(choice->currentIndex(), 1);
  EXPECT_NE(plot->grab().toImage(), before);
  keepPicture("texture_weave");
  // The wheel zooms the graph under the pointer, a drag shifts it, a double click shows all.
  const QPoint away = choice->mapToGlobal({5, 5});
  pointAt(away);
  const QImage whole = plot->grab().toImage();
  const QPoint in_first = plot->mapToGlobal({plot->width() / 6, plot->height() / 2});
  wheelAt(in_first, 4);
  const QImage nearer = plot->grab().toImage();
  EXPECT_NE(nearer, whole);
  drag(in_first, in_first + QPoint(30, 0));
  EXPECT_NE(plot->grab().toImage(), nearer);
  doubleClickAt(in_first);
  pointAt(away); // The plot shows the value under the pointer.
  EXPECT_EQ(plot->grab().toImage(), whole);
  // The new texture opens and is touched.
  clickOn("feel_demo");
  ASSERT_TRUE(waitUntil([&] {
    return window_->windowTitle().contains(QStringLiteral("never saved")) && view().isVisible();
  }));
  wait(500);
  keepPicture("texture_felt");
  EXPECT_TRUE(window_->isWindowModified());
  EXPECT_EQ(find<ToolBar>()->choice().handling, InteractionMode::press);
  EXPECT_EQ(find<ValueRow>("press_force")->findChild<QDoubleSpinBox*>()->value(), 1);
  // The toy lies in a temporary folder: the first save requests a folder, and the notice names it.
  for (const bool asked : {true, false}) {
    if (asked) answerWithPath(folder_ / "toy.patina");
    type('s', kControl);
    const QString where = QString::fromStdString((folder_ / "toy.patina").string());
    ASSERT_TRUE(waitUntil([&] { return !window_->isWindowModified(); }, 60000));
    EXPECT_EQ(edits().status().folder, folder_ / "toy.patina");
    EXPECT_TRUE(find<QLabel>("notice")->text().contains(where))
        << find<QLabel>("notice")->text().toStdString();
    EXPECT_TRUE(window_->windowTitle().startsWith(QStringLiteral("toy.patina")));
    setRow("stiffness", asked ? 700 : 800);
    EXPECT_TRUE(waitUntil([&] { return window_->isWindowModified(); }, 10000));
  }
}

TEST_F(TextureDeskTest, TitleHistoryAndGuideMatchTheShownScene) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 12), "sphere.obj")));
  setRow("stiffness", 700);
  ASSERT_TRUE(waitUntil([&] { return edits().status().done == 1; }, 20000));
  clickAction("desk_texture");
  const auto of_scene = [&] {
    return window_->windowTitle().startsWith(QStringLiteral("sphere.obj")) &&
           find<QWidget>("page_history")->isVisible() &&
           find<QWidget>("guide_strip")->isVisible() && window_->isWindowModified();
  };
  EXPECT_TRUE(of_scene()) << "the toy is not shown yet";
  clickOn("next_step");
  ASSERT_TRUE(rest());
  EXPECT_TRUE(window_->windowTitle().startsWith(QStringLiteral("The toy's scan")));
  EXPECT_FALSE(window_->isWindowModified());
  EXPECT_FALSE(find<QWidget>("page_history")->isVisible());
  EXPECT_FALSE(find<QWidget>("guide_strip")->isVisible());
  keepPicture("texture_begun");
  type('z', kControl);
  wait(300);
  EXPECT_EQ(edits().status().done, 1U) << "an invisible edit is not undone";
  clickOn("tab_library");
  EXPECT_TRUE(of_scene());
  clickOn("tab_steps");
  EXPECT_FALSE(of_scene());
  clickAction("desk_scan");
  EXPECT_TRUE(find<QWidget>("guide_strip")->isVisible());
  clickAction("desk_texture");
  desk().centralViews()->setFocus();
  type(kEnter);
  ASSERT_TRUE(desk().work()) << "Enter goes on where a step has ended";
  desk().cancel();
}

TEST_F(TextureDeskTest, RestartsACancelledStep) {
  clickAction("desk_texture");
  clickOn("next_step");
  ASSERT_TRUE(desk().work());
  wait(1500);
  desk().cancel();
  EXPECT_FALSE(desk().work());
  EXPECT_TRUE(find<QPushButton>("next_step")->isEnabled());
  EXPECT_TRUE(find<QPushButton>("next_step")->text().contains(QStringLiteral("Begin")));
}

TEST_F(TextureDeskTest, KeepsDeskToolAndForceIfTheToyDoesNotOpen) {
  clickAction("desk_texture");
  const ToolChoice tool = find<ToolBar>()->choice();
  const auto force = [&] {
    return find<ValueRow>("press_force")->findChild<QDoubleSpinBox*>()->value();
  };
  const double before = force();
  ASSERT_NE(before, 1);
  bool failed = false;
  QObject::connect(&documents(), &DocumentController::failed, [&] { failed = true; });
  emit desk().openRequested(QString::fromStdString((folder_ / "gone").string()));
  ASSERT_TRUE(waitUntil([&] { return failed; }, 20000));
  EXPECT_EQ(window_->controllers().desks.desk(), Desk::texture);
  EXPECT_TRUE(find<ToolBar>()->choice() == tool);
  EXPECT_EQ(force(), before);
}

TEST_F(TextureDeskTest, ShowsItsButtonsInANarrowWindowUntilFolded) {
  takeSize(1024, 700);
  clickAction("desk_texture");
  ASSERT_TRUE(find<QPushButton>("next_step")->isVisible());
  keepPicture("texture_narrow");
  EXPECT_EQ(window_->width(), 1024);
  clickOn("tab_steps");
  EXPECT_FALSE(find<QPushButton>("next_step")->isVisible());
  clickAction("desk_scan");
  EXPECT_LT(find<QWidget>("column")->width(), 60) << "no part of another desk";
}

TEST_F(TextureDeskTest, EnterPressesTheMainButtonOrTheFocusedOne) {
  clickAction("desk_texture");
  auto* messages = find<QToolButton>("page_messages");
  messages->setFocus(Qt::TabFocusReason);
  const int high = find<QWidget>("drawer")->height();
  type(kEnter);
  wait(100);
  EXPECT_LT(find<QWidget>("drawer")->height(), high) << "folded";
  EXPECT_FALSE(desk().work());
  desk().centralViews()->setFocus();
  type(kEnter);
  ASSERT_TRUE(desk().work()) << "the toy's scan";
  type(kEnter);
  wait(100);
  EXPECT_TRUE(find<QPushButton>("next_step")->isVisible()) << "nothing else is pressed meanwhile";
  desk().cancel();
}

TEST_F(TextureDeskTest, HeldEnterAndEnterInTextPressNothing) {
  clickAction("desk_texture");
  const auto enter = [](QWidget& to, bool again) {
    QKeyEvent event(QEvent::KeyPress, Qt::Key_Return, Qt::NoModifier, QStringLiteral("\r"), again);
    QApplication::sendEvent(&to, &event);
  };
  auto* next = find<QPushButton>("next_step");
  next->setFocus();
  enter(*next, true);
  EXPECT_FALSE(desk().work());
  desk().centralViews()->setFocus();
  enter(*desk().centralViews(), true);
  EXPECT_FALSE(desk().work());
  auto* line = new QLineEdit(next->parentWidget());
  line->show();
  line->setFocus();
  int taken = 0;
  QObject::connect(line, &QLineEdit::returnPressed, [&] { ++taken; });
  type(kEnter);
  EXPECT_EQ(taken, 1);
  EXPECT_FALSE(desk().work());
  next->setFocus();
  enter(*next, false);
  EXPECT_TRUE(desk().work());
  desk().cancel();
}

TEST_F(TextureDeskTest, MainButtonAndFocusedButtonLookDifferent) {
  clickAction("desk_texture");
  auto* main = find<QPushButton>("next_step");
  auto* other = find<QPushButton>("all_steps");
  other->setFocus();
  wait(100);
  const QImage unfocused = main->grab().toImage();
  main->setFocus();
  wait(100);
  keepPicture("texture_keys");
  EXPECT_NE(main->grab().toImage(), unfocused);
}

} // namespace
} // namespace patina
