// Where a tool that feels also paints: its ticks as strokes (K19, K20).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scene/stroke.h"
#include "scene/tool_sample.h"

namespace patina {

// One turn of a stroke, in this order: it begins, paints, ends.
struct StrokePiece {
  bool begins = false, ends = false;
  std::vector<StrokeSample> samples;
};

class StrokeTracker {
 public:
  struct Hand {
    bool down = false; // the pointer's button
    // A stroke begins only near there: a tip on its way to the place must not paint the way.
    Vec3 aim = Vec3::Zero();
    double near = 0; // [m]
    double off = 1;  // [m], at most, from a tick to the way between two samples
    // A device paints wherever it touches while its first button is held.
    bool device = false;
  };
  // Ticks in their order. A contact that is lost for kLost ends the stroke; it may begin again.
  std::vector<StrokePiece> feed(std::span<const ToolSample> ticks, const Hand& hand);
  std::vector<StrokePiece> finish(); // whatever is held
  void cancel();                     // a button of the device begins no other until it is let go
  bool painting() const { return painting_; }

  static constexpr double kSpacing = 1.0 / 120; // [s], between samples, and nearer at a corner
  static constexpr double kLost = 0.03;         // [s]

 private:
  void end(std::vector<StrokePiece>& pieces);

  bool painting_ = false;
  bool by_device_ = false;         // the last tick
  bool spent_ = false;             // its button, until it is let go
  double began_ = 0, touched_ = 0; // [s], servo's time
  std::vector<StrokeSample> way_;  // from the last sample on
};

} // namespace patina
