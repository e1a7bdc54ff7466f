#include "session/edit/stroke_tracker.h"

#include <utility>

namespace patina {
namespace {

constexpr unsigned kPaintButton = 1; // First button of the device.

StrokePiece& pieceIn(std::vector<StrokePiece>& pieces) {
  if (pieces.empty() || pieces.back().ends) pieces.emplace_back();
  return pieces.back();
}

} // namespace

void StrokeTracker::end(std::vector<StrokePiece>& pieces) {
  if (!std::exchange(painting_, false)) return;
  // A stroke ends at the tip, not at the last sample.
  if (path_.size() > 1) pieceIn(pieces).samples.push_back(path_.back());
  pieceIn(pieces).ends = true;
}

std::vector<StrokePiece> StrokeTracker::finish() {
  std::vector<StrokePiece> pieces;
  end(pieces);
  return pieces;
}

void StrokeTracker::cancel() {
  painting_ = false;
  spent_ = true;
}

std::vector<StrokePiece> StrokeTracker::feed(std::span<const ToolSample> ticks, const Hand& hand) {
  std::vector<StrokePiece> pieces;
  for (const ToolSample& tick : ticks) {
    by_device_ = hand.device && (tick.buttons & kPaintButton) != 0;
    const bool held = hand.down || by_device_;
    spent_ = spent_ && held;
    const bool device_paints = by_device_ && !spent_;
    if (!held || spent_) {
      end(pieces);
      continue;
    }
    if (!tick.contact) {
      if (painting_ && tick.t - touched_ > kLost) end(pieces);
      continue;
    }
    touched_ = tick.t;
    if (!painting_) {
      if (!device_paints && !((tick.surface - hand.aim).norm() <= hand.near)) continue;
      painting_ = true;
      began_ = tick.t;
      path_.clear();
      pieceIn(pieces).begins = true;
    }
    const auto take = [&](const StrokeSample& sample) {
      pieceIn(pieces).samples.push_back(sample);
      path_ = {sample};
    };
    const StrokeSample now{tick.t - began_, tick.surface, tick.force.norm(), tick.tip};
    if (!path_.empty() && deviatesFromChord(path_, now, hand.off)) take(StrokeSample(path_.back()));
    // Tolerates the clock's rounding.
    if (path_.empty() || now.t - path_.front().t >= kSpacing - 1e-4)
      take(now);
    else
      path_.push_back(now);
  }
  if (!hand.down && !(hand.device && by_device_)) end(pieces);
  return pieces;
}

} // namespace patina
