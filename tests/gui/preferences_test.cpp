// The page of preferences, by real events.
#include <QComboBox>
#include <QDialog>

#include "app/gui/loading/up_choice.h"
#include "app/gui/toolkit/system_theme.h"
#include "gui/driven_window.h"
#include "gui/misfits.h"

namespace patina {
namespace {

class PreferencesTest : public DrivenWindow {
 protected:
  void TearDown() override {
    if (!IsSkipped()) applyStyle(application(), Theme::light);
    DrivenWindow::TearDown();
  }
  QDialog& opened() {
    chooseInMenu(QStringLiteral("&Edit"), QStringLiteral("&Preferences…"));
    EXPECT_TRUE(waitUntil([&] { return find<QDialog>("preferences_dialog") != nullptr; }, 3000));
    wait(300);
    return *find<QDialog>("preferences_dialog");
  }
  bool becomes(const char* window) {
    return waitUntil([&] { return window_->palette().color(QPalette::Window) == window; }, 3000);
  }
};

TEST_F(PreferencesTest, ThemeAndUpperAxisAreAppliedAtOnceAndKept) {
  if (IsSkipped()) return;
  const SystemTheme theme(application(), QDBusConnection(QStringLiteral("no-bus")));
  EXPECT_TRUE(becomes("#f1f3f6"));
  QDialog& dialog = opened();
  const auto keepPicture = [&](const char* name) {
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      dialog.grab().save(QString::fromUtf8(folder) + '/' + name + ".png");
  };
  keepPicture("preferences");
  EXPECT_TRUE(test::misfits(dialog).isEmpty());
  click(*dialog.findChild<QComboBox*>("theme"));
  wait(200);
  type(QStringLiteral("dark"));
  type(kEnter);
  EXPECT_TRUE(becomes("#23272e"));
  keepPicture("preferences_dark");
  click(*dialog.findChild<QCheckBox*>("y_up"));
  EXPECT_EQ(rememberedUp(), UpAxis::y);
  type(kEscape);
  ASSERT_TRUE(waitUntil([&] { return find<QDialog>("preferences_dialog") == nullptr; }, 3000));
  const SystemTheme next(application(), QDBusConnection(QStringLiteral("no-bus")));
  EXPECT_TRUE(becomes("#23272e")) << "in the next session, too";
  QDialog& again = opened();
  EXPECT_TRUE(again.findChild<QCheckBox*>("y_up")->isChecked());
  click(*again.findChild<QComboBox*>("theme"));
  wait(200);
  type(QStringLiteral("as"));
  type(kEnter);
  EXPECT_TRUE(becomes("#f1f3f6"));
}

TEST_F(PreferencesTest, FileDialogsBeginInTheChosenFolder) {
  if (IsSkipped()) return;
  std::filesystem::create_directories(folder_ / "meshes");
  QDialog& dialog = opened();
  answerWithPath(folder_ / "meshes");
  click(*dialog.findChild<QPushButton*>("choose_folder"));
  ASSERT_TRUE(waitUntil(
      [&] { return lastFolder() == QString::fromStdString((folder_ / "meshes").string()); }, 5000))
      << lastFolder().toStdString();
  EXPECT_EQ(dialog.findChild<QLabel*>("first_folder")->text(), lastFolder());
}

} // namespace
} // namespace patina
