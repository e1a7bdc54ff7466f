// The desk for scans fits with a scan that has every message.
#include <sys/wait.h>

#include "app/gui/control/desk_controller.h"
#include "gui/misfits.h"
#include "gui/scan_fixture.h"

namespace patina {
namespace {

class ScanFit : public ScanDeskTest {
 protected:
  void check(const std::string& where) {
    QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
    const QStringList cut = test::misfits(*window_), mute = test::muteControls(*window_);
    EXPECT_TRUE(cut.isEmpty()) << where << "\n  " << cut.join("\n  ").toStdString();
    EXPECT_TRUE(mute.isEmpty()) << where << " says nothing\n  " << mute.join("\n  ").toStdString();
  }
  void checkAll(const QString& size) {
    DeskController& desks = window_->controllers().desks;
    desks.choose(Desk::scan);
    desks.foldSidePanel(false);
    desks.foldBottomPanel(false);
    scan().cursor().set(findingOf(Finding::Kind::outlier)->from); // the longest text
    for (const Panel page : {Panel::findings, Panel::messages, Panel::timeline}) {
      desks.open(page);
      wait(150);
      check(size.toStdString() + " page " + std::to_string(static_cast<int>(page)));
    }
    wait(200);
    keepPicture("scan_" + size);
    desks.foldSidePanel(true);
    desks.foldBottomPanel(true);
    wait(60);
    check(size.toStdString() + " folded");
  }
};

TEST_F(ScanFit, EveryPartAtEverySize) {
  ASSERT_TRUE(openScan());
  for (const QSize& size : {QSize(1024, 700), QSize(1280, 800), QSize(1440, 900)}) {
    takeSize(size.width(), size.height());
    checkAll(QStringLiteral("%1x%2").arg(size.width()).arg(size.height()));
  }
}

// This runs in a program of its own, with a scale of two.
TEST_F(ScanFit, DISABLED_AtTwice) {
  ASSERT_EQ(window_->devicePixelRatioF(), 2);
  ASSERT_TRUE(openScan());
  takeSize(1280, 760);
  checkAll("twice");
}

TEST(ScanFitAtTwice, TheDesk) {
  if (!test::hasDisplay()) GTEST_SKIP() << "neither Xvfb nor DISPLAY";
  const pid_t child = fork();
  if (child == 0) {
    setenv("QT_SCALE_FACTOR", "2", 1);
    execl("/proc/self/exe", "gui_tests", "--gtest_also_run_disabled_tests",
          "--gtest_filter=ScanFit.DISABLED_AtTwice", nullptr);
    _exit(1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0) << "what it printed is above";
}

// Writes the pictures of the dark theme on request.
TEST_F(ScanFit, EveryPartInTheDarkTheme) {
  window_.reset();
  applyStyle(application(), Theme::dark);
  window_ = std::make_unique<MainWindow>();
  window_->show();
  takeSize(1280, 800);
  const bool opened = openScan();
  if (opened) checkAll("dark");
  window_.reset();
  applyStyle(application(), Theme::light);
  EXPECT_TRUE(opened);
}

} // namespace
} // namespace patina
