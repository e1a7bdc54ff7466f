// The start page, which is shown if nothing is open, by pointer and keys.
#include "app/gui/window/welcome_page.h"

#include <QRegularExpression>

#include "app/gui/control/desk_controller.h"
#include "app/gui/loading/presets.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "scene/scene.h"

namespace patina {
namespace {

class WelcomeTest : public DrivenWindow {
 protected:
  WelcomePage& page() { return *find<WelcomePage>(); }
  bool isOpen(const std::string& name) {
    return waitUntil(
        [&] { return edits().scene() && edits().scene()->scene.objects[0].name == name; }, 30000);
  }
  void restart() {
    window_ = std::make_unique<MainWindow>();
    window_->show();
    takeSize(1280, 800);
  }
};

TEST_F(WelcomeTest, ClickOpensAPresetAndHidesThePage) {
  if (IsSkipped()) return;
  ASSERT_TRUE(page().isVisible());
  clickOn("preset_ball");
  ASSERT_TRUE(isOpen("ball"));
  EXPECT_FALSE(page().isVisible());
  EXPECT_TRUE(view().hasFocus()) << "the view has the focus";
}

TEST_F(WelcomeTest, PresetsCauseNoWarning) {
  if (IsSkipped()) return;
  clickOn("preset_dinosaur"); // parts of its feet are thin
  ASSERT_TRUE(isOpen("dinosaur"));
  wait(300);
  EXPECT_EQ(find<MessagePanel>()->count(), 0)
      << find<MessagePanel>()->item(0)->text().toStdString();
}

TEST_F(WelcomeTest, EnterOpensTheFirstPresetAndTabReachesTheOthers) {
  if (IsSkipped()) return;
  ASSERT_TRUE(waitUntil([&] { return find<QToolButton>("preset_dinosaur")->hasFocus(); }, 2000));
  type(kTab);
  EXPECT_TRUE(find<QToolButton>("preset_pottery")->hasFocus());
  type(kEnter);
  ASSERT_TRUE(isOpen("pottery"));
}

TEST_F(WelcomeTest, OffersRecentFilesAtTheNextStart) {
  if (IsSkipped()) return;
  ASSERT_TRUE(open(saved(icosphere(30, 12), "round.obj"), MeshUnit::mm));
  restart();
  ASSERT_TRUE(page().isVisible());
  for (QPushButton* button : page().findChildren<QPushButton*>())
    if (button->toolTip().endsWith("round.obj")) {
      click(*button);
      ASSERT_TRUE(isOpen("round"));
      return;
    }
  FAIL() << "round.obj is not there";
}

TEST_F(WelcomeTest, FailedLoadBringsThePageBack) {
  if (IsSkipped()) return;
  documents().setInteractive(false);
  bool failed = false;
  QObject::connect(&documents(), &DocumentController::failed, [&] { failed = true; });
  whenThere([] { return QApplication::activeModalWidget(); }, [this](QWidget&) { type(kEscape); });
  documents().open(requestFor(folder_ / "none.obj"));
  EXPECT_FALSE(page().isVisible());
  ASSERT_TRUE(waitUntil([&] { return failed; }, 5000));
  EXPECT_TRUE(waitUntil([&] { return page().isVisible(); }, 2000));
}

TEST_F(WelcomeTest, GuideLeadsToTheScan) {
  if (IsSkipped()) return;
  if (find<QPushButton>("welcome_guide") == nullptr) GTEST_SKIP() << "built without scans";
  clickOn("welcome_guide");
  EXPECT_EQ(window_->controllers().desks.desk(), Desk::scan);
  EXPECT_TRUE(find<GuideStrip>()->isVisible());
}

TEST_F(WelcomeTest, CardsAreWholeAndCentredWithNothingBesideThem) {
  if (IsSkipped()) return;
  clickAction("desk_paint"); // its drawer is open
  takeSize(1280, 620);
  auto* splitter = find<QSplitter>("across");
  EXPECT_FALSE(splitter->handle(1)->isVisible());
  EXPECT_FALSE(find<QWidget>("column")->isVisible());
  const auto cards = page().findChildren<QToolButton*>(QRegularExpression("^preset_"));
  QRect all;
  for (QToolButton* card : cards) {
    EXPECT_GE(card->height(), card->sizeHint().height());
    all |= QRect(card->mapTo(&page(), {0, 0}), card->size());
  }
  EXPECT_NEAR(all.center().x(), page().width() / 2, 2);
  EXPECT_TRUE(page().rect().contains(all));
  if (const char* folder = std::getenv("PATINA_PICTURES"))
    window_->grab().save(QStringLiteral("%1/welcome.png").arg(QString::fromUtf8(folder)));
  clickOn("preset_ball");
  ASSERT_TRUE(isOpen("ball"));
  wait(300);
  EXPECT_TRUE(splitter->handle(1)->isVisible());
  EXPECT_NEAR(find<QWidget>("column")->width(), 300, 2);
}

TEST(Presets, HaveOneObjectAndAPictureEach) {
  if (!test::hasDisplay()) GTEST_SKIP() << "neither Xvfb nor DISPLAY";
  application();
  for (const Preset& preset : presets()) {
    const Scene scene = presetScene(preset.name);
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].name, preset.name);
    EXPECT_GT(scene.objects[0].mesh->triangles.size(), 1000u);
    EXPECT_FALSE(pictureOf(preset).isNull());
  }
}

} // namespace
} // namespace patina
