// The desk for scans: its cells, cards and pages, and the scan that they show.
#pragma once

#include <filesystem>

#include <QSplitter>
#include <QStackedWidget>

#include "app/gui/panels/message_panel.h"
#include "app/gui/scanning/calibration_card.h"
#include "app/gui/scanning/finding_list.h"
#include "app/gui/scanning/frame_strip.h"
#include "app/gui/scanning/frame_view.h"
#include "app/gui/scanning/scan_panel.h"
#include "app/gui/scanning/scan_recording.h"
#include "app/gui/scanning/scan_traces.h"
#include "app/gui/scanning/scan_view.h"
#include "app/gui/scanning/scene_scans.h"
#include "app/gui/window/window_state.h"

namespace patina {

class ScanDesk : public QObject {
  Q_OBJECT
 public:
  explicit ScanDesk(QWidget& window); // to which it belongs

  // To be laid out by the window.
  QStackedWidget* cells() const { return cells_; }
  QWidget* panel() const { return panel_; }
  QWidget* recorder() const { return recorder_; }
  QWidget* calibration() const { return calibration_; }
  QWidget* timeline() const { return timeline_; }
  QWidget* findings() const { return findings_; }

  const OpenScan& scan() const { return scan_; }
  bool isOpen() const { return scan_.files() != nullptr; }
  const std::optional<Work>& work() const { return work_; }

  void open(const std::filesystem::path& folder);
  void open(const SceneScan& scan); // of the scene
  void openDialog();
  void cancel();
  void setSceneMesh(std::shared_ptr<const TriangleMesh> mesh); // nullptr: no scene is open
  void setScene(std::shared_ptr<const Scene> scene);           // whose scans there are
  SceneScans& scans() { return *scans_; }
  void fit();
  void setView(ViewPreset view);
  void refresh(); // of every tick of the window

 signals:
  void pathMade(const QString& name, const std::vector<patina::PathSample>& path);
  void opened(); // a person has asked for it, and there it is
  void changed();
  void said(const patina::Message& message);
  void openAsked(const QString& folder); // by a dialog

 private:
  void makeEmpty();
  void makeTimeline();
  void connectScan();
  void connectRecording();
  void connectScans();
  void connectCalibration();
  void openPictures();
  void use(const QString& file, const QString& text); // a calibration
  void takeScan();
  void drawPath();
  void drawProbe();
  void drawMesh();

  QWidget& window_;
  OpenScan scan_;
  QStackedWidget* cells_ = new QStackedWidget;
  QSplitter* across_ = new QSplitter(Qt::Horizontal);
  FrameView* frame_;
  ScanView* view_ = nullptr; // made with the first scan
  ScanPanel* panel_;
  CalibrationCard* calibration_;
  SceneScans* scans_ = new SceneScans;
  RecordPanel* recorder_ = new RecordPanel;
  ScanRecording recording_;
  QWidget* timeline_ = new QWidget;
  FindingList* findings_;
  std::shared_ptr<const TriangleMesh> scene_mesh_;
  std::optional<Work> work_;
  bool looked_at_ = false; // as a whole
};

} // namespace patina
