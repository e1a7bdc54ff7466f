// The page of the first hour, from nothing to a calibrated rig and a scan: four steps, each with a
// mark, its figure, and the button that does it; meanwhile the camera's live picture.
#pragma once

#include <array>
#include <atomic>

#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>

#include "app/gui/scanning/scan_recording.h"
#include "app/gui/toolkit/background.h"
#include "app/gui/toolkit/picture_view.h"
#include "scan/calibrate.h"
#include "scan/first_hour.h"

namespace patina {

class FirstHourPage : public QWidget {
  Q_OBJECT
 public:
  explicit FirstHourPage(QWidget* parent = nullptr);

  const FirstHour& hour() const { return hour_; }
  void refresh(); // Called on each tick of the window.
  void finish();  // At exit: returns when a recording is on disk.

 signals:
  void openRequested();
  void scanRequested(const patina::RecordingChoice& choice); // Record with the calibrated rig.

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  enum class Running { nothing, printing, photographing, waving, calibrating };
  enum Step { kPrint, kPhotograph, kWave, kScan, kSteps };
  struct Row {
    QLabel *mark, *name, *words;
    QPushButton* button;
  };

  QLineEdit* addLine(const char* name, const QString& caption, const QString& tip);
  void addStep(Step step, const char* button, const QString& name, const QString& tip);
  void act(Step step); // A click on its button: begins the step, or ends it.
  void print();
  void photograph();
  void wave();
  void calibrate(const std::filesystem::path& recording);
  void begin(Running running, const QString& words);
  void end(const QString& words, bool is_bad = false);
  void readFolder();
  void showSteps();
  void showBoard(const QImage& image, const std::vector<Vec2>& corners, const BoardGuide& guide);
  void showWave(const RecordingUpdate& news);
  std::filesystem::path folder() const { return folder_->text().trimmed().toStdString(); }

  Background job_;
  ScanRecording recording_;
  std::shared_ptr<std::atomic<bool>> ends_; // Ends the photographing, which keeps its views.
  Running running_ = Running::nothing;
  FirstHour hour_;
  QString read_;                 // The folder that `hour_` was read from.
  std::filesystem::path failed_; // The recording from which no rig was found.
  int ticks_ = 0;

  QWidget* settings_;
  QGridLayout* lines_;
  QLineEdit *folder_, *camera_, *board_, *measured_;
  QComboBox* shape_;
  QWidget* steps_;
  QGridLayout* grid_;
  std::array<Row, kSteps> rows_{};
  QLabel *advice_, *summary_, *note_;
  PictureView* live_;
  QWidget* room_; // Takes the place of the live picture.
};

} // namespace patina
