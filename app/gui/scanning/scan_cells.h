// The cells of the desk for scans: the frame and the path in 3D, or, while no scan is open, how to
// open one.
#pragma once

#include <QSplitter>
#include <QStackedWidget>

#include "app/gui/scanning/frame_view.h"
#include "app/gui/scanning/scan_panel.h"
#include "app/gui/scanning/scan_view.h"

namespace patina {

class ScanCells : public QStackedWidget {
  Q_OBJECT
 public:
  ScanCells(OpenScan& scan, ScanPanel& panel); // which says how it is shown

  FrameView& frame() { return *frame_; }
  void setSceneMesh(std::shared_ptr<const TriangleMesh> mesh); // nullptr: no scene is open
  void fit();
  void setView(ViewPreset view);
  void refresh(); // of every tick of the window

 signals:
  void openAsked();

 private:
  void makeEmpty();
  void takeScan();
  void drawPath();
  void drawProbe();
  void drawMesh();

  OpenScan& scan_;
  ScanPanel& panel_;
  QSplitter* across_ = new QSplitter(Qt::Horizontal);
  FrameView* frame_;
  ScanView* view_ = nullptr; // made with the first scan
  std::shared_ptr<const TriangleMesh> scene_mesh_;
  bool looked_at_ = false; // as a whole
};

} // namespace patina
