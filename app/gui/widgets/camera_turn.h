// The camera on its way to another side, in a fraction of a second.
#pragma once

#include <chrono>

#include <QTimer>

#include "app/gui/widgets/frame_pacer.h"

namespace patina {

class CameraTurn : public QObject {
 public:
  CameraTurn(SceneView& view, FramePacer& frames);
  void begin(const Vec3& direction); // to look from there; begins at once
  void stop();                       // where it is

 private:
  void step();

  SceneView& view_;
  FramePacer& frames_;
  Eigen::Quaterniond from_, to_;
  std::chrono::steady_clock::time_point begun_;
  QTimer timer_;
};

} // namespace patina
