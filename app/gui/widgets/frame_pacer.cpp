#include "app/gui/widgets/frame_pacer.h"

namespace patina {
namespace {
constexpr std::chrono::milliseconds kFrame{16};  // no frame is sooner after another
constexpr std::chrono::milliseconds kMoves{100}; // after its last event a camera still moves
constexpr double kSlow = 0.025; // [s]: pictures that take longer are drawn plainly while they move
} // namespace

FramePacer::FramePacer(SceneView& view, QVTKOpenGLNativeWidget& widget)
    : view_(view), widget_(widget) {
  soon_.setSingleShot(true);
  soon_.setTimerType(Qt::PreciseTimer);
  connect(&soon_, &QTimer::timeout, this, &FramePacer::refresh);
}

void FramePacer::cameraMoved() {
  moved_ = std::chrono::steady_clock::now();
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(drawn_ + kFrame - moved_);
  const int wait = std::max(0, static_cast<int>(left.count()));
  if (!soon_.isActive() || soon_.remainingTime() > wait) soon_.start(wait);
}

bool FramePacer::refresh() {
  const auto now = std::chrono::steady_clock::now();
  const bool moves = now - moved_ < kMoves;
  const bool plain = moves && whole_seconds_ > kSlow;
  view_.setMoving(plain);
  const bool changed = view_.prepare();
  if (!widget_.isVisible()) return false;
  // Smoothing costs 20 ms of a frame where OpenGL is software: a moving picture goes without it if
  // it is slow, and is smoothed once it stands still.
  const bool stands_still = now - drawn_ > std::chrono::milliseconds(150);
  if (!changed && (smooth_ || !stands_still)) return false;
  smooth_ = !plain && (!changed || frame_seconds_ < (smooth_ ? 0.040 : 0.020));
  view_.renderer().SetUseFXAA(smooth_);
  widget_.renderWindow()->Render();
  drawn_ = std::chrono::steady_clock::now();
  if (moves && changed) moved_ = drawn_; // events that the frame held up come now
  // The one smoothed frame of a picture that stands says nothing about moving ones.
  if (changed) frame_seconds_ = std::chrono::duration<double>(drawn_ - now).count();
  if (changed && !plain) whole_seconds_ = frame_seconds_;
  if (plain && !soon_.isActive()) soon_.start(kMoves); // and in full
  return changed;
}

bool FramePacer::settled() {
  return smooth_ && !refresh();
}

} // namespace patina
