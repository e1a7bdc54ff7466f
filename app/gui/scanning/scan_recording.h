// Records a scan in the background.
#pragma once

#include <memory>

#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QObject>
#include <QPushButton>

#include "acquisition/recording/recording_state.h"
#include "app/gui/toolkit/background.h"
#include "scan/record_scan.h"
#include "scan/scan_files.h"

namespace patina {

// The sources of a recording and its folder.
struct RecordingChoice {
  QString frames, probe; // In the syntax of openFrames() and openProbe(); no probe: empty.
  QString calibration;   // Folder of camera.yml and rig.json.
  QString folder;
};

class RecordPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit RecordPanel(QWidget* parent = nullptr);

  RecordingChoice choice() const;
  void suggestCalibration(const QString& folder) { // Used if none is chosen.
    if (calibration_->text().isEmpty()) calibration_->setText(folder);
  }
  void choose(const RecordingChoice& choice); // Keeps the chosen probe if `choice` has none.
  void setState(const RecordingState* state); // nullptr: no recording.

 signals:
  void recordRequested();
  void pauseRequested(bool pauses);
  void stopRequested();

 private:
  QLineEdit* addPath(const char* name, const QString& caption, const QString& tip);
  void suggestFolder();

  QWidget* sources_;
  QLineEdit *frames_, *probe_, *calibration_, *folder_;
  QPushButton *record_, *pause_, *stop_;
  QLabel *count_, *lost_;
};

class ScanRecording : public QObject {
  Q_OBJECT
 public:
  explicit ScanRecording(QObject* parent);

  void begin(const RecordingChoice& choice);
  void pause(bool pauses);
  void end();     // ended() follows.
  void finish();  // Returns when everything is on disk; no signal follows.
  void refresh(); // Emits updates; called on each tick of the window.
  bool running() const { return recorder_ != nullptr; }

 signals:
  void begun(const patina::ScanFiles& files); // Data known at the start.
  void updated(const patina::RecordingUpdate& news);
  void ended(const QString& folder, const QString& problem); // Everything is on disk.
  void failed(const QString& message);                       // The recording did not start.
  void noted(const QString& line); // A note about its frames, before ended().

 private:
  // The job that stops the recorder may hold its last reference.
  std::shared_ptr<Recorder> recorder_;
  std::filesystem::path folder_;
  Background job_;
  bool ends_ = false; // The job completes a recording.
};

} // namespace patina
