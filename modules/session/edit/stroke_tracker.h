// Turns the ticks of a tool in contact into strokes (K19, K20).
#pragma once

#include <span>
#include <vector>

#include "scene/stroke.h"
#include "scene/tool_sample.h"

namespace patina {

// Part of a stroke. It begins, paints and ends, in this order.
struct StrokePiece {
  bool begins = false, ends = false;
  std::vector<StrokeSample> samples;
};

class StrokeTracker {
 public:
  struct Hand {
    bool down = false; // State of the pointer's button.
    // A stroke begins only near the aim, because the tip must not paint on its path to it.
    Vec3 aim = Vec3::Zero();
    double near = 0; // [m]
    double off = 1;  // Largest distance of a tick from the chord between two samples [m].
    // A device paints wherever it touches while its first button is held.
    bool device = false;
  };
  // Takes ticks in order. A contact lost for kLost ends the stroke; it may begin again.
  std::vector<StrokePiece> feed(std::span<const ToolSample> ticks, const Hand& hand);
  std::vector<StrokePiece> finish(); // Ends the current stroke.
  void cancel(); // Ends it without result; what is held starts no other until it is released.
  bool painting() const { return painting_; }

  static constexpr double kSpacing = 1.0 / 120; // Spacing of samples, closer at a corner [s].
  static constexpr double kLost = 0.03;         // [s]

 private:
  void end(std::vector<StrokePiece>& pieces);

  bool painting_ = false;
  bool by_device_ = false;         // The last tick was the device's.
  bool spent_ = false;             // What is held must be released first.
  double began_ = 0, touched_ = 0; // Servo time [s].
  std::vector<StrokeSample> path_; // Ticks since the last sample.
};

} // namespace patina
