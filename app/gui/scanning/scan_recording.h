// A recording that runs behind the window: begun and ended without holding it up.
#pragma once

#include <memory>

#include <QObject>

#include "acquisition/recording/recorder.h"
#include "app/gui/scanning/record_panel.h"
#include "app/gui/window/background.h"
#include "scan/scan_files.h"

namespace patina {

class ScanRecording : public QObject {
  Q_OBJECT
 public:
  explicit ScanRecording(QObject* parent);

  void begin(const RecordingChoice& choice);
  void pause(bool pauses);
  void end();     // ended() follows
  void refresh(); // of every tick of the window: tells what has come
  bool running() const { return recorder_ != nullptr; }

 signals:
  void begun(const patina::ScanFiles& files); // what is known from the start
  void came(const patina::RecordingNews& news);
  void ended(const QString& folder, const QString& problem); // it is all on disk
  void failed(const QString& message);                       // it did not begin
  void noted(const QString& line);                           // of its frames, before it has ended

 private:
  std::shared_ptr<Recorder> recorder_; // its last user may be the thread that ends it
  std::filesystem::path folder_;
  Background job_;
};

} // namespace patina
