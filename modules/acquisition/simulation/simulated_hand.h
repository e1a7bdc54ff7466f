// A hand that scans a known height field: strokes, presses, pauses, reversals and lift-offs.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/types.h"

namespace patina {

struct HandState {
  Vec3 tip = Vec3::Zero();                                         // [m], z up
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity(); // world_from_probe
  double force = 0;                                                // [N]
  double surface = 0; // unloaded surface under the tip [m]
  bool touching = false;
};

// A move of the tip from its present position to above `to` in `seconds`, at rest at both ends,
// with a lateral deviation `lateral_bow`. A move to the present position is a pause.
struct HandMove {
  Vec2 to = Vec2::Zero(); // [m]
  double seconds = 1;
  double lateral_bow = 0; // lateral deviation at the middle [m]
  double force = 0;       // at the end, reached smoothly; in contact above 0 [N]
  double lift = 0;        // at the end: 0 on the surface, 1 in the air
};

struct SimulatedHand {
  Vec2 from = Vec2::Zero();    // start, in the air
  double travel_height = 5e-3; // travel height in the air [m]
  std::vector<HandMove> moves;
  std::function<double(const Vec2&)> relief = [](const Vec2&) { return 0.; }; // surface [m]
  double compliance = 1. / 3000; // compliance of the surface [m/N]
  // Direction opposite to the indentation, unit.
  std::function<Vec3(const Vec2&)> normal = [](const Vec2&) { return Vec3(Vec3::UnitZ()); };
  // Sums of sines with phases and frequencies from the seed.
  double tilt = 0.14;        // slow rotation of the probe, amplitude about x and y [rad]
  double tremor = 30e-6;     // at 8 to 11 Hz, tangential [m]
  double tremor_tilt = 4e-4; // [rad]
  double force_noise = 0.15; // relative noise of the force, below 3 Hz
  std::uint32_t seed = 1;
  // Free motion at a time [s] (hand_gestures.h); if set, it replaces the moves, which then only
  // state how long it lasts.
  std::function<HandState(double)> gesture;

  double seconds() const;
};

// A hand with the state at the start of each move, so that states at any number of times take time
// in proportion to their number. Refers to the hand, which must stay as it is.
class HandCourse {
 public:
  HandCourse(const SimulatedHand& hand); // converts, so that handAt() also accepts a hand

 private:
  friend HandState handAt(const HandCourse& course, double t);
  struct Start {
    Vec2 place;
    double force = 0, lift = 1, time = 0;
    Start after(const HandMove& move, double share) const; // after this share of the move
  };
  const SimulatedHand* hand_;
  std::vector<Start> starts_; // one for each move, then the end
};

// Returns the state at any time; the hand rests before and after its moves.
HandState handAt(const HandCourse& course, double t);

// Area of the strokes: a box, and paths with `reachable` points only.
struct StrokeArea {
  Vec2 low{-0.06, -0.06}, high{0.06, 0.06}; // [m]
  std::function<bool(const Vec2&)> reachable = [](const Vec2&) { return true; };
};

// Returns about twenty seconds of strokes, some with pauses, reversals and lift-offs, for studies
// and tests. Strokes are at least a third of the area's shorter side; if there are none, down to a
// twelfth, below which it throws Error.
SimulatedHand strokes(std::uint32_t seed, double seconds = 20, double speed = 0.05,
                      const StrokeArea& area = {});

} // namespace patina
