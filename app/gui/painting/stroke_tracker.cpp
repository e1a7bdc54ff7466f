#include "app/gui/painting/stroke_tracker.h"

namespace patina {

std::vector<StrokePiece> StrokeTracker::feed(std::span<const ToolSample> ticks, const Hand& hand) {
  std::vector<StrokePiece> pieces;
  const auto piece = [&]() -> StrokePiece& {
    if (pieces.empty() || pieces.back().ends) pieces.emplace_back();
    return pieces.back();
  };
  const auto end = [&] {
    painting_ = false;
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
      StrokePiece& first = piece();
      first.begins = true;
      first.samples.push_back({0, tick.surface, tick.force.norm(), tick.tip});
      taken_ = tick.t;
    } else if (tick.t - taken_ >= kSpacing - 1e-4) { // a clock's rounding is not a tick
      piece().samples.push_back({tick.t - began_, tick.surface, tick.force.norm(), tick.tip});
      taken_ = tick.t;
    }
  }
  if (painting_ && !hand.down) end();
  return pieces;
}

} // namespace patina
