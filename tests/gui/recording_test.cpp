// A recording is discarded only if the user confirms it.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <utility>

#include <QDialog>
#include <QMessageBox>
#include <QTimer>

#include "core/csv.h"
#include "core/error.h"
#include "core/file.h"
#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"
#include "haptics/servo/feel.h"
#include "session/compile/compile_scene.h"
#include "support/fresh_folder.h"
#include "support/resident.h"
#include "support/small_disk.h"
#include "visualization/export/export_files.h"

namespace patina {
namespace {

class RecordingTable : public ::testing::Test {
 protected:
  void SetUp() override { folder_ = test::freshFolder("recording"); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path state() const { return folder_ / "state"; }

  // Ticks of a tip that goes up and down, in and out of a ball.
  static std::vector<ToolSample> ticks(std::size_t count) {
    std::vector<ToolSample> samples(count);
    for (std::size_t i = 0; i < count; ++i) {
      samples[i].t = 1e-3 * static_cast<double>(i);
      samples[i].tip = {0, std::sin(samples[i].t) / 3, 1.0 / static_cast<double>(i + 7)};
      samples[i].contact = i % 2 == 0;
      samples[i].step_ns = static_cast<std::uint32_t>(i);
    }
    return samples;
  }

  std::filesystem::path folder_;
};

TEST_F(RecordingTable, FailedSaveKeepsTheRowsAndASuccessfulOneClears) {
  Recording recording(state());
  recording.start(3);
  recording.add(ticks(5), 3);
  EXPECT_THROW(recording.save("/no/such/folder/log.csv"), FileError);
  ASSERT_NE(recording.log(), nullptr);
  EXPECT_EQ(recording.log()->rows(), 5U);
  recording.save(folder_ / "log.csv");
  EXPECT_EQ(recording.log(), nullptr);
  EXPECT_EQ(readCsv(folder_ / "log.csv", {"t [s]", "x [m]"}).rows.size(), 5U);
  EXPECT_TRUE(std::filesystem::is_empty(state()));
}

TEST_F(RecordingTable, BytesEqualThoseOfATableWrittenAtOnce) {
  const std::vector<ToolSample> all = ticks(20000); // more than a megabyte
  Recording recording(state());
  recording.start(0);
  SampleLog log(folder_ / "log.csv", 0);
  for (std::size_t i = 0; i < all.size(); i += 33) {
    const std::vector<ToolSample> some(
        all.begin() + static_cast<std::ptrdiff_t>(i),
        all.begin() + static_cast<std::ptrdiff_t>(std::min(i + 33, all.size())));
    log.add(some, 0);
    recording.add(some, 0);
  }
  log.flush();
  recording.save(folder_ / "saved.csv");
  writeToolSamplesCsv(folder_ / "whole.csv", all);
  EXPECT_EQ(readFile(folder_ / "log.csv"), readFile(folder_ / "whole.csv"));
  EXPECT_EQ(readFile(folder_ / "saved.csv"), readFile(folder_ / "whole.csv"));
}

TEST_F(RecordingTable, CountsSamplesLostByTheRingWhileRecording) {
  SampleLog log(folder_ / "log.csv", 3);
  log.add({}, 5); // 2
  log.pause();
  log.add({}, 9);
  log.resume();
  log.add({}, 10); // 1
  EXPECT_EQ(log.lost(), 3U);
}

TEST_F(RecordingTable, FullDiskLosesOnlyWhatDoesNotFitIntoMemory) {
  SampleLog log(folder_ / "log.csv", 0);
  const std::vector<ToolSample> all = ticks(60000);
  {
    const test::SmallDisk full(4096);
    log.add(all, 0);
    EXPECT_THROW(log.flush(), FileError);
    EXPECT_NE(log.problem(), "");
  }
  log.flush();
  EXPECT_EQ(log.problem(), "");
  EXPECT_GT(log.rows(), 10000U) << "ten seconds and more";
  EXPECT_EQ(log.rows() + log.lost(), all.size());
  EXPECT_EQ(readCsv(folder_ / "log.csv", {"t [s]"}).rows.size(), log.rows());
}

TEST_F(RecordingTable, RecoveredOneHasWholeRowsOnly) {
  Autosave place(state());
  std::ofstream(place.recording()) << "t [s],x [m]\n0,1\n0.001,2\n0.002,";
  saveRecovered(place, folder_ / "saved.csv");
  EXPECT_EQ(readFile(folder_ / "saved.csv"), "t [s],x [m]\n0,1\n0.001,2\n");
}

// The short form feels five minutes into a file, the long form a day into nowhere.
TEST_F(RecordingTable, DayOfServoInSimulatedTimeHoldsEightMegabytes) {
  Scene scene;
  scene.field.resolution = 40;
  scene.objects.push_back(
      {"ball", std::make_shared<const TriangleMesh>(icosphere(0.03, 8)), Pose::Identity(), {}});
  Progress progress;
  const auto compiled = compile(std::move(scene), progress);
  const std::size_t count = 1000 * (test::isLong() ? 86400UL : 300UL);
  SampleLog log(test::isLong() ? std::filesystem::path("/dev/null") : folder_ / "log.csv", 0);
  std::size_t next = 0, touching = 0, largest = 0;
  std::vector<ToolSample> batch;
  const std::size_t before = test::residentBytes();
  feel(
      *compiled->snapshot,
      [&]() -> std::optional<TimedTip> {
        if (next == count) return std::nullopt;
        const double t = 1e-3 * static_cast<double>(next++);
        return TimedTip{t, 0.0302 * Vec3(std::cos(t), std::sin(t), 0) +
                               Vec3(0.001 * std::sin(7 * t), 0, 0.001 * std::sin(3 * t))};
      },
      [&](const ToolSample& sample) {
        touching += sample.contact;
        batch.push_back(sample);
        if (batch.size() < 33) return;
        log.add(std::exchange(batch, {}), 0);
        if (log.rows() % 990 != 0) return;
        log.flush(); // simulated time outruns a disk
        largest = std::max(largest, test::residentBytes());
      },
      progress);
  log.add(batch, 0);
  log.flush();
  std::printf("%zu ticks, %.1f MB more\n", log.rows(), static_cast<double>(largest - before) / 1e6);
  EXPECT_EQ(log.rows(), count);
  EXPECT_EQ(log.lost(), 0U);
  EXPECT_GT(touching, count / 5);
  EXPECT_LE(largest, before + 8'000'000);
}

class Recorded : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 8), "sphere.obj")));
  }
  // Answers modal windows: `button` for a question, Cancel for any other.
  void answerWith(QMessageBox::StandardButton button) {
    QObject::connect(&answers_, &QTimer::timeout, [this, button] {
      QWidget* modal = QApplication::activeModalWidget();
      if (modal == nullptr) return;
      ++asked_;
      if (auto* box = qobject_cast<QMessageBox*>(modal)) {
        said_ = box->text();
        box->button(button)->click();
      } else if (auto* dialog = qobject_cast<QDialog*>(modal))
        dialog->reject();
    });
    answers_.start(20);
  }
  int ticksSaid() const { return said_.split(' ').first().toInt(); }
  QTimer answers_;
  int asked_ = 0;
  QString said_; // text of the last question
};

TEST_F(Recorded, TimeIncreasesAcrossAReload) {
  startLog();
  wait(300);
  ASSERT_TRUE(open(saved(icosphere(0.03, 10), "other.obj")));
  wait(300);
  const auto samples = logged();
  ASSERT_GT(samples.size(), 300U);
  for (std::size_t i = 1; i < samples.size(); ++i) ASSERT_GT(samples[i].t, samples[i - 1].t) << i;
}

TEST_F(Recorded, ButtonIsRedAndShowsTheDurationWhileRecording) {
  auto* button = find<QToolButton>("record_button");
  ASSERT_NE(button, nullptr);
  const QString plain = button->text();
  trigger("record");
  ASSERT_TRUE(waitUntil([&] { return button->text().endsWith(QStringLiteral("0:01")); }, 5000));
  EXPECT_TRUE(button->text().startsWith(QStringLiteral("●")));
  const QColor ground = button->grab().toImage().pixelColor(4, button->height() / 2);
  EXPECT_GT(ground.red(), 2 * std::max(ground.green(), ground.blue()));
  answerWith(QMessageBox::Discard);
  trigger("record");
  EXPECT_TRUE(waitUntil([&] { return button->text() == plain; }, 3000)) << "it is unchanged";
}

TEST_F(Recorded, KeyRDoesNotChangeTheLog) {
  startLog();
  wait(300);
  const std::size_t before = logged().size();
  ASSERT_GT(before, 50U);
  trigger("record");
  wait(50);
  answerWith(QMessageBox::Discard);
  trigger("record");
  EXPECT_FALSE(find<QAction>("record")->isChecked());
  EXPECT_GE(logged().size(), before);
}

TEST_F(Recorded, CancelledSaveContinuesRecording) {
  trigger("record");
  EXPECT_TRUE(find<QAction>("record")->isChecked());
  wait(300);
  answerWith(QMessageBox::Cancel);
  trigger("record");
  EXPECT_GE(asked_, 2); // the file name, then the action
  EXPECT_TRUE(find<QAction>("record")->isChecked());
  const int before = ticksSaid();
  EXPECT_GT(before, 50);
  wait(300);
  trigger("record");
  EXPECT_GT(ticksSaid(), before + 50) << "the earlier ones, and more";
}

TEST_F(Recorded, CloseAsksAndCancelKeepsTheWindow) {
  trigger("record");
  wait(200);
  answerWith(QMessageBox::Cancel);
  EXPECT_FALSE(window_->close());
  EXPECT_TRUE(window_->isVisible());
  EXPECT_GT(ticksSaid(), 0);
  EXPECT_TRUE(find<QAction>("record")->isChecked());
  answers_.disconnect();
  answerWith(QMessageBox::Discard);
  EXPECT_TRUE(window_->close());
}

TEST_F(Recorded, CloseAsksNothingIfNotInteractive) {
  trigger("record");
  wait(100);
  documents().setInteractive(false);
  answerWith(QMessageBox::Cancel);
  EXPECT_TRUE(window_->close());
  EXPECT_EQ(asked_, 0);
}

TEST_F(Recorded, CloseAsksAboutEditsUntilTheyAreSaved) {
  EXPECT_FALSE(window_->isWindowModified());
  setRow("stiffness", 321);
  EXPECT_TRUE(window_->isWindowModified());
  answerWith(QMessageBox::Cancel);
  EXPECT_FALSE(window_->close());
  EXPECT_EQ(asked_, 1);
  saving().saveTo(QString::fromStdString((folder_ / "ws").string()));
  EXPECT_FALSE(window_->isWindowModified());
  EXPECT_TRUE(window_->close());
  EXPECT_EQ(asked_, 1);
}

TEST_F(Recorded, RecordingOfAKilledWindowIsOfferedAndSaved) {
  std::filesystem::path left;
  {
    Autosave place(folder_ / "state" / "patina");
    SampleLog log(place.recording(), 0);
    log.add(std::vector<ToolSample>(100), 0);
    log.flush();
    place.keepForRecovery();
    left = place.recording().parent_path();
  }
  auto* bar = find<QWidget>("recover_bar");
  window_->controllers().recovery.begin();
  ASSERT_TRUE(bar->isVisible());
  answerWith(QMessageBox::Cancel); // cancels the file's name
  find<QAbstractButton>("recover")->click();
  EXPECT_FALSE(bar->isVisible());
  EXPECT_GE(asked_, 1);
  EXPECT_TRUE(holdsRecording(left)) << "it was not saved";
  window_->controllers().recovery.begin();
  ASSERT_TRUE(bar->isVisible());
  find<QAbstractButton>("forget")->click();
  EXPECT_FALSE(std::filesystem::exists(left));
}

} // namespace
} // namespace patina
