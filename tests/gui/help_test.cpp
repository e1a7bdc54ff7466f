// A user finds commands by words, keys and the guide.
#include <QDialog>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QTextBrowser>

#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"

namespace patina {
namespace {

class Help : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
    click(view());
  }
  QListWidget* search(const QString& words) {
    hand_->key(kControl, true);
    hand_->key(kShift, true);
    type('p');
    hand_->key(kShift, false);
    hand_->key(kControl, false);
    if (!waitUntil([&] { return find<QWidget>("action_search") != nullptr; }, 3000)) return nullptr;
    waitUntil([&] { return find<QLineEdit>("action_words")->hasFocus(); }, 3000);
    type(words);
    return find<QListWidget>("action_list");
  }
};

TEST_F(Help, WordFindsAnActionAndReturnRunsIt) {
  ASSERT_FALSE(find<QAction>("orthographic")->isChecked());
  QListWidget* list = search(QStringLiteral("orthographic"));
  ASSERT_NE(list, nullptr);
  ASSERT_TRUE(waitUntil([&] { return list->count() == 1; }, 3000));
  EXPECT_TRUE(list->item(0)->text().endsWith(QStringLiteral("O"))) << "its key";
  type(kEnter);
  EXPECT_TRUE(waitUntil([&] { return find<QAction>("orthographic")->isChecked(); }, 3000));
}

TEST_F(Help, DisabledActionsAreGreyAndDoNotRun) {
  QListWidget* list = search(QStringLiteral("undo"));
  ASSERT_NE(list, nullptr);
  ASSERT_TRUE(waitUntil([&] { return list->count() == 1; }, 3000));
  EXPECT_FALSE(list->item(0)->flags() & Qt::ItemIsEnabled);
  type(kEnter);
  wait(100);
  EXPECT_NE(find<QWidget>("action_search"), nullptr) << "still there, because nothing was done";
}

TEST_F(Help, WordFindsASettingOfAPanelAndReturnShowsIt) {
  QListWidget* list = search(QStringLiteral("show field ext"));
  ASSERT_NE(list, nullptr);
  ASSERT_TRUE(waitUntil([&] { return list->count() == 2; }, 3000)) << "the menu's and the row";
  type(kEscape);
  ASSERT_TRUE(waitUntil([&] { return find<QWidget>("action_search") == nullptr; }, 3000));
  list = search(QStringLiteral("touch stiff"));
  ASSERT_NE(list, nullptr);
  ASSERT_TRUE(waitUntil([&] { return list->count() == 1; }, 3000));
  type(kEnter);
  auto* number = find<ValueRow>("stiffness")->findChild<QDoubleSpinBox*>();
  ASSERT_TRUE(waitUntil([&] { return number->isVisible() && number->hasFocus(); }, 3000));
}

TEST_F(Help, SaysIfNothingIsCalledThat) {
  QListWidget* list = search(QStringLiteral("xyzzy"));
  ASSERT_NE(list, nullptr);
  ASSERT_TRUE(waitUntil([&] { return list->count() == 1; }, 3000));
  EXPECT_EQ(list->item(0)->text(), QStringLiteral("Nothing is called “xyzzy”"));
  type(kEnter);
  wait(100);
  EXPECT_NE(find<QWidget>("action_search"), nullptr);
}

TEST_F(Help, GuideEqualsTheDocument) {
  QListWidget* list = search(QStringLiteral("user guide"));
  ASSERT_NE(list, nullptr);
  ASSERT_TRUE(waitUntil([&] { return list->count() == 1; }, 3000));
  type(kEnter);
  ASSERT_TRUE(waitUntil([&] { return find<QTextBrowser>("guide_text") != nullptr; }, 3000));
  auto* text = find<QTextBrowser>("guide_text");
  EXPECT_TRUE(text->toPlainText().contains(QStringLiteral("Patina")));
  EXPECT_GT(text->toPlainText().size(), 10000);
  ASSERT_TRUE(waitUntil([&] { return text->window()->isActiveWindow(); }, 3000));
  type(kEscape);
  EXPECT_TRUE(waitUntil([&] { return find<QWidget>("user_guide") == nullptr; }, 3000));
}

TEST_F(Help, MouseAndKeysFitOnASmallScreen) {
  QSize size;
  bool ok = false;
  whenAsked<QDialog>([&](QDialog& dialog) {
    size = dialog.size();
    for (auto* button : dialog.findChildren<QPushButton*>()) ok = ok || button->isVisible();
    type(kEscape);
  });
  type(kF1);
  EXPECT_TRUE(waitUntil([&] { return ok && !QApplication::activeModalWidget(); }, 5000));
  EXPECT_LE(size.height(), 620);
  EXPECT_LE(size.width(), 900);
}

TEST_F(Help, ExportOpensInParaView) {
  answerWithPath(folder_ / "out");
  QListWidget* list = search(QStringLiteral("paraview"));
  ASSERT_NE(list, nullptr);
  ASSERT_TRUE(waitUntil([&] { return list->count() == 1; }, 3000));
  type(kEnter);
  ASSERT_TRUE(waitUntil([&] { return std::filesystem::exists(folder_ / "out" / "scene.vtm"); }));
  for (const char* file : {"mesh.vtp", "surface.vtp", "field.vti", "vertices.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / file)) << file;
}

TEST_F(Help, QueuedExportsAreAllMadeAndTheSecondReportsItsWait) {
  QStringList notified;
  QObject::connect(&saving(), &SaveController::notified,
                   [&](const Message& message) { notified << message.words; });
  for (const char* name : {"one", "two", "three"})
    saving().exportTo(QString::fromStdString((folder_ / name).string()));
  for (const char* name : {"one", "two", "three"})
    EXPECT_TRUE(waitUntil([&] { return std::filesystem::exists(folder_ / name / "scene.vtm"); }))
        << name;
  ASSERT_TRUE(waitUntil([&] { return notified.filter(QStringLiteral("Exported")).size() == 3; }));
  EXPECT_EQ(notified.filter(QStringLiteral("starts after the running one")).size(), 2);
  EXPECT_TRUE(notified.filter(QStringLiteral("Exported")).front().contains(QStringLiteral("one")));
}

} // namespace
} // namespace patina
