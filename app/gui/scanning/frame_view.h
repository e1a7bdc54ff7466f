// Shows the current frame, its markers, and the projected axes and tip of the probe.
#pragma once

#include <map>

#include <QImage>
#include <QLabel>
#include <QWidget>

#include "acquisition/recording/recording_state.h"
#include "app/gui/scanning/open_scan.h"
#include "app/gui/toolkit/elided_label.h"
#include "app/gui/toolkit/picture_view.h"
#include "scan/calibrate.h"

namespace patina {

QImage imageOf(const GreyFrame& frame);
std::vector<PictureMark> markerMarks(const std::vector<SeenMarker>& markers); // Outlines and ids.

class FrameView : public QWidget {
  Q_OBJECT
 public:
  explicit FrameView(OpenScan& scan, QWidget* parent = nullptr);
  void showLive(const RecordedFrame& frame);
  void addBoard(std::size_t frame, const BoardView& view); // Shown until another scan is opened.

 private:
  void load(); // Loads the cursor's frame unless it is already shown.
  void refresh();
  void describe();
  void sayWhy(const QString& why); // Empty: no problem.

  OpenScan& scan_;
  ElidedLabel* title_;
  PictureView* canvas_;
  QLabel* why_;
  Background job_;
  std::optional<std::size_t> requested_;
  QImage picture_;
  std::optional<Camera> camera_; // Turned like the picture.
  std::vector<PictureMark> markers_;
  std::map<std::size_t, std::vector<Vec2>> boards_; // Corners for each frame.
  QString fault_;
};

} // namespace patina
