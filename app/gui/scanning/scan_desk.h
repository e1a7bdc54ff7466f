// The desk for scans: its cells, cards and pages, and the scan that they show.
#pragma once

#include <filesystem>
#include <map>

#include "app/gui/panels/message_panel.h"
#include "app/gui/scanning/calibration_card.h"
#include "app/gui/scanning/finding_list.h"
#include "app/gui/scanning/scan_cells.h"
#include "app/gui/scanning/scan_recording.h"
#include "app/gui/scanning/scene_scans.h"
#include "app/gui/window/window_state.h"

namespace patina {

class ScanDesk : public QObject {
  Q_OBJECT
 public:
  explicit ScanDesk(QWidget& window); // to which it belongs

  // To be laid out by the window.
  ScanCells* cells() const { return cells_; }
  std::map<Panel, QWidget*> panels() const;

  const OpenScan& scan() const { return scan_; }
  bool isOpen() const { return scan_.files() != nullptr; }
  const std::optional<Work>& work() const { return work_; }

  void open(const std::filesystem::path& folder);
  void open(const SceneScan& scan); // of the scene
  void openDialog();
  void cancel();
  void setScene(std::shared_ptr<const Scene> scene); // whose scans there are
  SceneScans& scans() { return *scans_; }
  void refresh(); // of every tick of the window

 signals:
  void pathMade(const QString& name, const std::vector<patina::PathSample>& path);
  void textureAsked();
  void opened(); // a person has asked for it, and there it is
  void changed();
  void said(const patina::Message& message);
  void openAsked(const QString& folder); // by a dialog

 private:
  void connectScan();
  void connectRecording();
  void connectScans();
  void connectCalibration();
  void use(const QString& file, const QString& text); // a calibration
  void takeScan();

  QWidget& window_;
  OpenScan scan_;
  ScanPanel* panel_;
  ScanCells* cells_;
  CalibrationCard* calibration_;
  SceneScans* scans_ = new SceneScans;
  RecordPanel* recorder_ = new RecordPanel;
  ScanRecording recording_;
  QWidget* timeline_;
  FindingList* findings_;
  std::optional<Work> work_;
};

} // namespace patina
