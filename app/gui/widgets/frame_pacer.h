// When the 3D view is drawn: soon after the camera has moved, else with the window's ticks, and
// never sooner after another frame than the eye can tell.
#pragma once

#include <chrono>

#include <QTimer>
#include <QVTKOpenGLNativeWidget.h>

#include "visualization/view/scene_view.h"

namespace patina {

class FramePacer : public QObject {
 public:
  FramePacer(SceneView& view, QVTKOpenGLNativeWidget& widget);
  void cameraMoved(); // draws soon: not with the next tick only
  bool refresh();     // draws if anything changed since the last call; false if nothing did
  bool settled();     // what is shown is up to date and smoothed

 private:
  SceneView& view_;
  QVTKOpenGLNativeWidget& widget_;
  double frame_seconds_ = 0; // that the last frame took in which something had changed
  double whole_seconds_ = 0; // the same, of a frame that was not simplified
  bool smooth_ = false;      // the last frame was anti-aliased
  std::chrono::steady_clock::time_point drawn_, moved_;
  QTimer soon_;
};

} // namespace patina
