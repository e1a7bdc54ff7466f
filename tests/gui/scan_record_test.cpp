// A recording from a replay, paused, refused, and killed.
#include <csignal>

#include <QLineEdit>

#include <sys/wait.h>

#include "core/csv.h"
#include "gui/scan_fixture.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class ScanRecord : public ScanDeskTest {
 protected:
  // The scan follows itself four times, so that a slow machine still records when a test presses a
  // button for the last time.
  void SetUp() override {
    ScanDeskTest::SetUp();
    if (IsSkipped()) return;
    CsvTable frames = readCsv(scan_ / "frames.csv", {}), probe = readCsv(scan_ / "probe.csv", {});
    const std::size_t pictures = frames.rows.size();
    const double length =
        std::max(frames.rows.back()[1] + frames.rows[1][1], probe.rows.back()[0] + 0.001); // s
    follow(frames, {static_cast<double>(pictures), length});
    follow(probe, {length});
    for (std::size_t i = pictures; i < frames.rows.size(); ++i)
      fs::copy_file(frame(i % pictures), frame(i));
    writeCsv(scan_ / "frames.csv", frames);
    writeCsv(scan_ / "probe.csv", probe);
  }
  // Appends the rows three times, each time with `step` added to their first columns.
  static void follow(CsvTable& table, const std::vector<double>& step) {
    const std::size_t rows = table.rows.size();
    for (std::size_t i = rows; i < 4 * rows; ++i) {
      std::vector<double> row = table.rows[i - rows];
      for (std::size_t c = 0; c < step.size(); ++c) row[c] += step[c];
      table.rows.push_back(std::move(row));
    }
  }
  void record(const fs::path& into, std::size_t poses = 20) {
    clickAction("desk_scan");
    const QString from = QString::fromStdString("replay:" + scan_.string());
    find<QLineEdit>("record_frames")->setText(from);
    find<QLineEdit>("record_probe")->setText(from);
    find<QLineEdit>("record_calibration")->setText(QString::fromStdString(scan_.string()));
    find<QLineEdit>("record_folder")->setText(QString::fromStdString(into.string()));
    clickOn("record_scan");
    ASSERT_TRUE(
        waitUntil([&] { return scan().grows() && scan().path()->path.size() > poses; }, 20000));
  }
  static std::size_t framesIn(const fs::path& folder) { return framesOf(folder, 0).size(); }
};

TEST_F(ScanRecord, ReplayIsShownLivePausedAndOpened) {
  const fs::path into = folder_ / "recorded";
  record(into, 3);
  EXPECT_TRUE(find<QLabel>("frame_title")->text().startsWith(QStringLiteral("Live")));
  clickOn("pause_scan");
  ASSERT_TRUE(waitUntil(
      [&] { return find<QLabel>("record_count")->text().startsWith(QStringLiteral("Paused")); },
      5000));
  // A replay waits for a slow tracker, so its own time is what must pass.
  ASSERT_TRUE(scan().path());
  const double from = scan().path()->poses.back().t;
  ASSERT_TRUE(waitUntil(
      [&] { return !scan().path() || scan().path()->poses.back().t > from + 0.8; }, 20000));
  ASSERT_TRUE(scan().path()) << "the replay ended in the pause, which began at " << from << " s";
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
  // The pause is a gap, and is reported once the path is computed from all frames.
  const auto longestGap = [&] {
    double longest = 0;
    for (const Finding& finding : scan().path()->findings)
      if (finding.kind == Finding::Kind::gap)
        longest = std::max(longest, finding.to - finding.from);
    return longest;
  };
  EXPECT_TRUE(waitUntil([&] { return longestGap() > 0.6; }, 20000)) << longestGap();
}

TEST_F(ScanRecord, FailedRecordingGivesItsCauseAndWritesNothing) {
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

// This runs in a program of its own, which is killed while it records.
TEST_F(ScanRecord, DISABLED_IsKilled) {
  record(std::getenv("PATINA_RECORD_INTO"));
  wait(500);
  const std::size_t poses = scan().path()->poses.size();
  wait(1000);
  std::ofstream(std::string(std::getenv("PATINA_RECORD_INTO")) + ".poses") << poses << std::flush;
  raise(SIGKILL);
}

TEST_F(ScanRecord, KillLosesAtMostTheLastSecond) {
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
  // All data that existed a second before the kill are kept.
  EXPECT_GE(scan().path()->poses.size(), poses);
  EXPECT_GE(framesIn(into), poses);
}

} // namespace
} // namespace patina
