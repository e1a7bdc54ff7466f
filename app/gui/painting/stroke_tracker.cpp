#include "app/gui/painting/stroke_tracker.h"

namespace patina {

std::vector<StrokePiece> StrokeTracker::feed(std::span<const ToolSample> ticks, const Hand& hand) {
  std::vector<StrokePiece> pieces;
  const auto piece = [&]() -> StrokePiece& {
    if (pieces.empty() || pieces.back().ends) pieces.emplace_back();
    return pieces.back();
  };
  const auto end = [&] { // where the tip is, not where the last sample fell
    painting_ = false;
    if (way_.size() > 1) piece().samples.push_back(way_.back());
    piece().ends = true;
  };
  for (const ToolSample& tick : ticks) {
    if (!hand.down) break;
    if (!tick.contact) {
      if (painting_ && tick.t - touched_ > kLost) end();
      continue;
    }
    touched_ = tick.t;
    if (!painting_) {
      if (!((tick.surface - hand.aim).norm() <= hand.near)) continue;
      painting_ = true;
      began_ = tick.t;
      way_.clear();
      piece().begins = true;
    }
    const auto take = [&](const StrokeSample& sample) {
      piece().samples.push_back(sample);
      way_ = {sample};
    };
    const StrokeSample now{tick.t - began_, tick.surface, tick.force.norm(), tick.tip};
    if (!way_.empty() && strays(way_, now, hand.off)) take(StrokeSample(way_.back()));
    if (way_.empty() || now.t - way_.front().t >= kSpacing - 1e-4) // a clock's rounding is no tick
      take(now);
    else
      way_.push_back(now);
  }
  if (painting_ && !hand.down) end();
  return pieces;
}

} // namespace patina
