// A recording from a replay, paused, refused, and killed.
#ifdef PATINA_HAS_ACQUISITION
#include <csignal>

#include <QLineEdit>

#include <sys/wait.h>

#include "gui/scan_fixture.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class ScanRecord : public ScanDeskTest {
 protected:
  void record(const fs::path& into) {
    clickAction("desk_scan");
    const QString from = QString::fromStdString("replay:" + scan_.string());
    find<QLineEdit>("record_frames")->setText(from);
    find<QLineEdit>("record_probe")->setText(from);
    find<QLineEdit>("record_calibration")->setText(QString::fromStdString(scan_.string()));
    find<QLineEdit>("record_folder")->setText(QString::fromStdString(into.string()));
    clickOn("record_scan");
    ASSERT_TRUE(
        waitUntil([&] { return scan().grows() && scan().path()->path.size() > 20; }, 20000));
  }
  static std::size_t framesIn(const fs::path& folder) { return framesOf(folder, 0).size(); }
};

TEST_F(ScanRecord, AReplayIsSeenAsItComesPausedAndOpened) {
  const fs::path into = folder_ / "recorded";
  record(into);
  EXPECT_TRUE(find<QLabel>("frame_title")->text().startsWith(QStringLiteral("Live")));
  clickOn("pause_scan");
  ASSERT_TRUE(waitUntil(
      [&] { return find<QLabel>("record_count")->text().startsWith(QStringLiteral("Paused")); },
      5000));
  wait(700);
  clickOn("pause_scan");
  wait(500);
  EXPECT_GT(scan().path()->probe.size(), 100U);
  keepPicture("scan_live");
  wait(200);
  clickOn("stop_scan");
  ASSERT_TRUE(waitUntil([&] {
    return !scan().grows() && scan().files() != nullptr && scan().files()->folder == into &&
           !desk().work();
  }));
  wait(300);
  keepPicture("scan_recorded");
  const std::vector<Frame>& frames = scan().files()->frames;
  ASSERT_GT(frames.size(), 30U);
  EXPECT_GT(scan().path()->poses.size(), 20U);
  // The pause is a gap, and says so once the path is made of all frames.
  const auto longestGap = [&] {
    double longest = 0;
    for (const Finding& finding : scan().path()->findings)
      if (finding.kind == Finding::Kind::gap)
        longest = std::max(longest, finding.to - finding.from);
    return longest;
  };
  EXPECT_TRUE(waitUntil([&] { return longestGap() > 0.6; }, 20000)) << longestGap();
}

TEST_F(ScanRecord, WhatCannotBeRecordedSaysWhyAndWritesNothing) {
  clickAction("desk_scan");
  const fs::path into = folder_ / "nothing";
  find<QLineEdit>("record_frames")->setText(QStringLiteral("/no/such/video.avi"));
  find<QLineEdit>("record_calibration")->setText(QString::fromStdString(scan_.string()));
  find<QLineEdit>("record_folder")->setText(QString::fromStdString(into.string()));
  bool asked = false;
  whenAsked<QDialog>([&](QDialog& dialog) {
    asked = true;
    dialog.close();
  });
  clickOn("record_scan");
  ASSERT_TRUE(waitUntil([&] { return asked; }, 10000));
  EXPECT_FALSE(fs::exists(into));
  EXPECT_EQ(scan().files(), nullptr);
}

// In a program of its own, which is killed while it records.
TEST_F(ScanRecord, DISABLED_IsKilled) {
  record(std::getenv("PATINA_RECORD_INTO"));
  wait(500);
  const std::size_t poses = scan().path()->poses.size();
  wait(1000);
  std::ofstream(std::string(std::getenv("PATINA_RECORD_INTO")) + ".poses") << poses << std::flush;
  raise(SIGKILL);
}

TEST_F(ScanRecord, AKillLosesAtMostTheLastSecond) {
  const fs::path into = folder_ / "killed";
  const pid_t child = fork();
  if (child == 0) {
    setenv("PATINA_RECORD_INTO", into.c_str(), 1);
    execl("/proc/self/exe", "gui_tests", "--gtest_also_run_disabled_tests",
          "--gtest_filter=ScanRecord.DISABLED_IsKilled", nullptr);
    _exit(1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "it was not killed while it recorded";
  std::size_t poses = 0;
  std::ifstream(into.string() + ".poses") >> poses;
  ASSERT_GT(poses, 20U);
  documents().open(requestFor(into));
  ASSERT_TRUE(waitUntil([&] { return scan().path() != nullptr && !desk().work(); }));
  // All that was there a second before it died.
  EXPECT_GE(scan().path()->poses.size(), poses);
  EXPECT_GE(framesIn(into), poses);
}

} // namespace
} // namespace patina
#endif
