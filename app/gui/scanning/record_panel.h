// From where a scan is recorded, and how far it is.
#pragma once

#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>

#include "acquisition/recording/recorder.h"

namespace patina {

struct RecordingChoice {
  QString frames, probe; // as openFrames() and openProbe() have them; no probe: empty
  QString calibration;   // folder of camera.yml and rig.json
  QString folder;        // of the scan that is made
};

class RecordPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit RecordPanel(QWidget* parent = nullptr);

  RecordingChoice choice() const;
  void suggestCalibration(const QString& folder); // where none is chosen
  void setState(const RecordingState* state);     // nullptr: nothing is recorded

 signals:
  void recordAsked();
  void pauseAsked(bool pauses);
  void stopAsked();

 private:
  QLineEdit* addPath(const char* name, const QString& caption, const QString& tip);
  void suggestFolder();

  QWidget* sources_;
  QLineEdit *frames_, *probe_, *calibration_, *folder_;
  QPushButton *record_, *pause_, *stop_;
  QLabel *count_, *lost_;
};

} // namespace patina
