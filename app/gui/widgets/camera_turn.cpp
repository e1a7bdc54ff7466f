#include "app/gui/widgets/camera_turn.h"

#include <algorithm>

#include "visualization/view/camera.h"

namespace patina {
namespace {
constexpr double kTurnSeconds = 0.25;
constexpr int kTurnStep = 16; // [ms]
} // namespace

CameraTurn::CameraTurn(SceneView& view, FramePacer& frames) : view_(view), frames_(frames) {
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &CameraTurn::step);
}

void CameraTurn::begin(const Vec3& direction) {
  from_ = turnOf(*view_.renderer().GetActiveCamera());
  to_ = turnFrom(direction);
  begun_ = std::chrono::steady_clock::now();
  timer_.start(kTurnStep);
}

void CameraTurn::stop() {
  timer_.stop();
}

void CameraTurn::step() {
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - begun_;
  const double part = std::min(1., since.count() / kTurnSeconds);
  const double eased = part * part * (3 - 2 * part);
  setTurn(*view_.renderer().GetActiveCamera(), part < 1 ? from_.slerp(eased, to_) : to_);
  frames_.cameraMoved();
  if (part == 1) stop();
}

} // namespace patina
