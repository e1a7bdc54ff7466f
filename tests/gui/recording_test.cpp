// What was recorded is lost only when somebody says so.
#include <QDialog>
#include <QMessageBox>
#include <QTimer>

#include "core/csv.h"
#include "core/error.h"
#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"
#include "support/fresh_folder.h"

namespace patina {
namespace {

TEST(RecordingBuffer, AFailedWriteKeepsTheSamplesAndASuccessfulOneEmptiesIt) {
  Recording recording;
  recording.start(3);
  std::vector<ToolSample> samples(5);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].t = static_cast<double>(i);
  recording.add(samples, 3);
  EXPECT_THROW(recording.save("/no/such/folder/log.csv"), FileError);
  EXPECT_EQ(recording.samples().size(), 5U);
  const auto path = test::freshFolder("recording") / "log.csv";
  recording.save(path);
  EXPECT_TRUE(recording.samples().empty());
  EXPECT_EQ(readCsv(path, {"t [s]", "x [m]"}).rows.size(), 5U);
  std::filesystem::remove_all(path.parent_path());
}

TEST(RecordingBuffer, CountsWhatTheRingLostWhileItWasOn) {
  Recording recording;
  recording.start(3);
  recording.add({}, 5); // 2
  recording.pause();
  recording.add({}, 9);
  recording.resume();
  recording.add({}, 10); // 1
  EXPECT_EQ(recording.lost(), 3U);
}

class Recorded : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 8), "sphere.obj")));
  }
  // Answers modal windows as they come: `button` of a question, Cancel of anything else.
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
  QString said_; // by the last question
};

TEST_F(Recorded, TimeIncreasesOverAReload) {
  feel().startLog();
  wait(300);
  ASSERT_TRUE(open(saved(icosphere(0.03, 10), "other.obj")));
  wait(300);
  const auto samples = feel().log().samples();
  ASSERT_GT(samples.size(), 300U);
  for (std::size_t i = 1; i < samples.size(); ++i) ASSERT_GT(samples[i].t, samples[i - 1].t) << i;
}

TEST_F(Recorded, WhileItRecordsTheButtonIsRedAndSaysForHowLong) {
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
  EXPECT_TRUE(waitUntil([&] { return button->text() == plain; }, 3000)) << "it is as it was";
}

TEST_F(Recorded, RLeavesTheLogAlone) {
  feel().startLog();
  wait(300);
  const std::size_t before = feel().log().samples().size();
  ASSERT_GT(before, 50U);
  trigger("record");
  wait(50);
  answerWith(QMessageBox::Discard);
  trigger("record");
  EXPECT_FALSE(find<QAction>("record")->isChecked());
  EXPECT_GE(feel().log().samples().size(), before);
}

TEST_F(Recorded, ACancelledSaveGoesOnRecording) {
  trigger("record");
  EXPECT_TRUE(find<QAction>("record")->isChecked());
  wait(300);
  answerWith(QMessageBox::Cancel);
  trigger("record");
  EXPECT_GE(asked_, 2); // the name, then what to do
  EXPECT_TRUE(find<QAction>("record")->isChecked());
  const int before = ticksSaid();
  EXPECT_GT(before, 50);
  wait(300);
  trigger("record");
  EXPECT_GT(ticksSaid(), before + 50) << "those of before, and more";
}

TEST_F(Recorded, ClosingAsksAndCancelKeepsTheWindow) {
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

TEST_F(Recorded, WithNobodyToAskClosingJustCloses) {
  trigger("record");
  wait(100);
  documents().setAsks(false);
  answerWith(QMessageBox::Cancel);
  EXPECT_TRUE(window_->close());
  EXPECT_EQ(asked_, 0);
}

TEST_F(Recorded, EditsAreAskedAboutUntilTheyAreSaved) {
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

} // namespace
} // namespace patina
