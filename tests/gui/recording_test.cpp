// What was recorded is lost only when somebody says so.
#include <QDialog>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QTimer>

#include "core/csv.h"
#include "core/error.h"
#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"

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
  const auto path = std::filesystem::temp_directory_path() /
                    ("patina-recording-" + std::to_string(getpid()) + ".csv");
  recording.save(path);
  EXPECT_TRUE(recording.samples().empty());
  EXPECT_EQ(readCsv(path, {"t [s]", "x [m]"}).rows.size(), 5U);
  std::filesystem::remove(path);
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
      if (auto* box = qobject_cast<QMessageBox*>(modal))
        box->button(button)->click();
      else if (auto* dialog = qobject_cast<QDialog*>(modal))
        dialog->reject();
    });
    answers_.start(20);
  }
  QAction* recordAction() {
    for (QAction* menu : window_->menuBar()->actions())
      for (QAction* action : menu->menu()->actions())
        if (action->shortcut() == QKeySequence(Qt::Key_R)) return action;
    return nullptr;
  }
  QTimer answers_;
  int asked_ = 0;
};

TEST_F(Recorded, TimeIncreasesOverAReload) {
  window_->startRecording();
  wait(300);
  ASSERT_TRUE(open(saved(icosphere(0.03, 10), "other.obj")));
  wait(300);
  const auto samples = window_->takeRecording();
  ASSERT_GT(samples.size(), 300U);
  for (std::size_t i = 1; i < samples.size(); ++i) ASSERT_GT(samples[i].t, samples[i - 1].t) << i;
}

TEST_F(Recorded, RLeavesTheLogAlone) {
  window_->startLog();
  wait(300);
  const std::size_t before = window_->log().samples().size();
  ASSERT_GT(before, 50U);
  window_->startRecording();
  wait(50);
  window_->takeRecording();
  EXPECT_GE(window_->log().samples().size(), before);
}

TEST_F(Recorded, ACancelledSaveGoesOnRecording) {
  QAction* action = recordAction();
  ASSERT_NE(action, nullptr);
  action->trigger();
  wait(300);
  const std::size_t before = window_->recording().samples().size();
  ASSERT_GT(before, 50U);
  answerWith(QMessageBox::Cancel);
  action->trigger();
  EXPECT_GE(asked_, 2); // the name, then what to do
  EXPECT_TRUE(action->isChecked());
  EXPECT_TRUE(window_->recording().on());
  EXPECT_GE(window_->recording().samples().size(), before);
}

TEST_F(Recorded, ClosingAsksAndCancelKeepsTheWindow) {
  window_->startRecording();
  wait(200);
  answerWith(QMessageBox::Cancel);
  EXPECT_FALSE(window_->close());
  EXPECT_TRUE(window_->isVisible());
  EXPECT_FALSE(window_->recording().samples().empty());
  answers_.disconnect();
  answerWith(QMessageBox::Discard);
  EXPECT_TRUE(window_->close());
}

TEST_F(Recorded, WithNobodyToAskClosingJustCloses) {
  window_->startRecording();
  wait(100);
  window_->setAsks(false);
  answerWith(QMessageBox::Cancel);
  EXPECT_TRUE(window_->close());
  EXPECT_EQ(asked_, 0);
}

TEST_F(Recorded, EditsAreAskedAboutUntilTheyAreSaved) {
  EXPECT_FALSE(window_->isWindowModified());
  HapticProperties haptics = window_->haptics().values();
  haptics.stiffness = 321;
  window_->haptics().setValues(haptics);
  emit window_->haptics().edited(haptics);
  EXPECT_TRUE(window_->isWindowModified());
  answerWith(QMessageBox::Cancel);
  EXPECT_FALSE(window_->close());
  EXPECT_EQ(asked_, 1);
  window_->saveWorkspaceTo(QString::fromStdString((folder_ / "ws").string()));
  EXPECT_FALSE(window_->isWindowModified());
  EXPECT_TRUE(window_->close());
  EXPECT_EQ(asked_, 1);
}

} // namespace
} // namespace patina
