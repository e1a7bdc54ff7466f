#include "app/gui/painting/stroke_tracker.h"

#include <utility>

namespace patina {
namespace {

constexpr unsigned kPaintButton = 1; // of the device: the first

StrokePiece& pieceIn(std::vector<StrokePiece>& pieces) {
  if (pieces.empty() || pieces.back().ends) pieces.emplace_back();
  return pieces.back();
}

} // namespace

void StrokeTracker::end(std::vector<StrokePiece>& pieces) {
  if (!std::exchange(painting_, false)) return;
  // Where the tip is, not where the last sample fell.
  if (way_.size() > 1) pieceIn(pieces).samples.push_back(way_.back());
  pieceIn(pieces).ends = true;
}

std::vector<StrokePiece> StrokeTracker::finish() {
  std::vector<StrokePiece> pieces;
  end(pieces);
  return pieces;
}

void StrokeTracker::cancel() {
  painting_ = false;
  spent_ = by_device_;
}

std::vector<StrokePiece> StrokeTracker::feed(std::span<const ToolSample> ticks, const Hand& hand) {
  std::vector<StrokePiece> pieces;
  for (const ToolSample& tick : ticks) {
    by_device_ = hand.device && (tick.buttons & kPaintButton) != 0;
    spent_ = spent_ && by_device_;
    const bool device_paints = by_device_ && !spent_;
    if (!hand.down && !device_paints) {
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
      way_.clear();
      pieceIn(pieces).begins = true;
    }
    const auto take = [&](const StrokeSample& sample) {
      pieceIn(pieces).samples.push_back(sample);
      way_ = {sample};
    };
    const StrokeSample now{tick.t - began_, tick.surface, tick.force.norm(), tick.tip};
    if (!way_.empty() && strays(way_, now, hand.off)) take(StrokeSample(way_.back()));
    if (way_.empty() || now.t - way_.front().t >= kSpacing - 1e-4) // a clock's rounding is no tick
      take(now);
    else
      way_.push_back(now);
  }
  if (!hand.down && !(hand.device && by_device_)) end(pieces);
  return pieces;
}

} // namespace patina
