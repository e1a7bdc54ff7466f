// Central views of the desk Scan: the frame and the path in 3D, or the page of the first hour;
// and the panel with their display options.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QGroupBox>
#include <QSplitter>
#include <QStackedWidget>

#include "app/gui/scanning/first_hour_page.h"
#include "app/gui/scanning/frame_view.h"
#include "app/gui/scanning/open_scan.h"
#include "app/gui/scanning/scan_drawing.h"
#include "app/gui/scanning/scan_view.h"
#include "app/gui/toolkit/card.h"

namespace patina {

// Facts about the open scan, and its display options.
class ScanPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit ScanPanel(OpenScan& scan, QWidget* parent = nullptr);

  PathColor color() const { return static_cast<PathColor>(color_->currentIndex()); }
  bool showsMesh() const { return mesh_->isChecked(); }
  bool showsCamera() const { return camera_->isChecked(); }
  void setHasMesh(bool has) { mesh_->setEnabled(has); }
  void refresh();

 signals:
  void openRequested();
  void keepRequested();
  void textureRequested();
  void closeRequested();
  void shownChanged();

 private:
  void fill();

  OpenScan& scan_;
  FactTable* figures_ = nullptr;
  QWidget* shown_;
  QComboBox* color_;
  QCheckBox *mesh_, *camera_;
  QPushButton *keep_, *texture_, *close_;
};

class ScanCentralViews : public QStackedWidget {
  Q_OBJECT
 public:
  ScanCentralViews(OpenScan& scan, ScanPanel& panel); // The panel has the display options.

  FrameView& frame() { return *frame_; }
  FirstHourPage& firstHour() { return *first_hour_; }
  void setSceneMesh(std::shared_ptr<const TriangleMesh> mesh); // nullptr: no scene is open.
  void fit() {
    if (view_ != nullptr && view_->isVisible()) view_->picture().fit();
  }
  void setView(ViewPreset view) {
    if (view_ != nullptr && view_->isVisible()) view_->picture().setView(view);
  }
  void refresh() { // Called on each tick of the window.
    first_hour_->refresh();
    if (view_ != nullptr) view_->refresh();
  }

 private:
  void takeScan();
  void drawPath();
  void drawProbe();
  void drawMesh();

  OpenScan& scan_;
  ScanPanel& panel_;
  FirstHourPage* first_hour_ = new FirstHourPage; // Shown while no scan is open.
  QSplitter* across_ = new QSplitter(Qt::Horizontal);
  FrameView* frame_;
  ScanView* view_ = nullptr; // Made with the first scan.
  std::shared_ptr<const TriangleMesh> scene_mesh_;
  bool looked_at_ = false; // The view was fitted to the scan.
};

} // namespace patina
