// The desk Scan: its views and panels, and the scan that they show.
#pragma once

#include <filesystem>
#include <map>

#include <QGroupBox>
#include <QLineEdit>

#include "app/gui/panels/message_panel.h"
#include "app/gui/scanning/open_scan.h"
#include "app/gui/scanning/scan_central_views.h"
#include "app/gui/scanning/scan_recording.h"
#include "app/gui/scanning/scene_scans.h"
#include "app/gui/state/window_state.h"
#include "app/gui/toolkit/words.h"
#include "scan/calibrate.h"

namespace patina {

// Calibrates a camera from pictures of a board (the open scan, a video or a live camera), or a tip
// from the scan's poses. The user looks at the result and then uses it.
class CalibrationCard : public QGroupBox {
  Q_OBJECT
 public:
  explicit CalibrationCard(OpenScan& scan, QWidget* parent = nullptr);
  bool busy() const { return job_.busy(); }
  void cancel();

 signals:
  void picturesRequested();
  void boardSeen(std::size_t frame, const patina::BoardView& view); // Frame of the scan.
  // Uses the open scan, if any.
  void useRequested(const QString& file, const QString& text);
  void progressed(double fraction);
  void changed();

 private:
  void findCamera();
  void findTip();
  void offer(const QString& words, const QString& file, const std::string& text);
  void bringIntoView(); // Scrolls to the result.
  void refuse(const QString& problem) { offer(withoutCommands(problem), {}, {}); }
  void refresh();

  OpenScan& scan_;
  Background job_;
  QLineEdit *board_, *source_;
  QPushButton *pictures_, *camera_, *tip_, *use_;
  QLabel* found_;
  QString file_, text_; // The result; empty: none.
};

// Lists the parts of a scan that are missing or rejected; a click goes there.
class FindingList : public QListWidget {
  Q_OBJECT
 public:
  explicit FindingList(OpenScan& scan, QWidget* parent = nullptr);

 private:
  void fill();
  void follow(); // Selects the finding at the cursor.

  OpenScan& scan_;
};

class ScanDesk : public QObject {
  Q_OBJECT
 public:
  explicit ScanDesk(QWidget& window);

  ScanCentralViews* centralViews() const { return central_views_; }
  std::map<Panel, QWidget*> panels() const;

  const OpenScan& scan() const { return scan_; }
  bool isOpen() const { return scan_.files() != nullptr; }
  const std::optional<TaskProgress>& work() const { return work_; }

  void open(const std::filesystem::path& folder);
  void open(const SceneScan& scan);
  void openDialog();
  void cancel() {
    scan_.cancel();
    calibration_->cancel();
  }
  void setScene(std::shared_ptr<const Scene> scene); // The scene whose scans are listed.
  SceneScans& scans() { return *scans_; }
  void refresh() { // Called on each tick of the window.
    recording_.refresh();
    central_views_->refresh();
  }
  void finishRecording() { // At exit: returns when it is on disk.
    central_views_->firstHour().finish();
    recording_.finish();
  }

 signals:
  void pathMade(const QString& name, const std::vector<patina::PathSample>& path);
  void textureRequested();
  void opened(); // Opened by the user.
  void changed();
  void notified(const patina::Message& message);
  void openRequested(const QString& folder);

 private:
  void begin(const QString& title) {
    work_ = TaskProgress{title, title};
    emit changed();
  }
  void connectScan();
  void connectRecording();
  void connectScans();
  void connectCalibration();
  void use(const QString& file, const QString& text);
  void takeScan();

  QWidget& window_;
  OpenScan scan_;
  ScanPanel* panel_;
  ScanCentralViews* central_views_;
  CalibrationCard* calibration_;
  SceneScans* scans_ = new SceneScans;
  RecordPanel* recorder_ = new RecordPanel;
  ScanRecording recording_;
  QWidget* timeline_;
  FindingList* findings_;
  std::optional<TaskProgress> work_;
};

} // namespace patina
