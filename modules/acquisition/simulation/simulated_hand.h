// A hand that scans what is a height over a plane, known exactly: strokes, presses, pauses, turns
// and lift-offs.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/types.h"

namespace patina {

// What the hand does next. The tip moves from where it is to above `to` in `seconds`, starting and
// ending at rest, bowing aside by `bow`; to where it is means standing.
struct HandMove {
  Vec2 to = Vec2::Zero(); // [m]
  double seconds = 1;
  double bow = 0;   // sideways at its middle [m]
  double force = 0; // at its end, reached smoothly: above 0 the tip touches [N]
  double lift = 0;  // of the tip at its end: 0 is on the surface, 1 in the air
};

struct SimulatedHand {
  Vec2 from = Vec2::Zero(); // where it begins, in the air
  double air = 5e-3;        // the height at which it moves there [m]
  std::vector<HandMove> moves;
  std::function<double(const Vec2&)> relief = [](const Vec2&) { return 0.; }; // the surface [m]
  double compliance = 1. / 3000; // how far it yields [m/N]
  // Against which way it yields, unit.
  std::function<Vec3(const Vec2&)> normal = [](const Vec2&) { return Vec3(Vec3::UnitZ()); };
  // Sums of sines, of which the seed draws phases and frequencies.
  double tilt = 0.14;         // slow turning of the probe, amplitude about x and y [rad]
  double tremor = 30e-6;      // at 8 to 11 Hz, along the plate [m]
  double tremor_tilt = 4e-4;  // [rad]
  double unsteadiness = 0.15; // of the force, relative, below 3 Hz
  std::uint32_t seed = 1;

  double seconds() const;
};

struct HandState {
  Vec3 tip = Vec3::Zero();                                         // [m], z up
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity(); // world_from_probe
  double force = 0;                                                // [N]
  double surface = 0; // under the tip, not yielding [m]
  bool touching = false;
};

// Any t; before and after the moves the hand rests.
HandState handAt(const SimulatedHand& hand, double t);

// Where a hand may go: points between two corners, and ways all of whose points are `reachable`.
struct StrokeArea {
  Vec2 low{-0.06, -0.06}, high{0.06, 0.06}; // [m]
  std::function<bool(const Vec2&)> reachable = [](const Vec2&) { return true; };
};

// Twenty seconds or so of strokes, some with pauses, turns back and lift-offs: what studies and
// tests scan. They are a third of the area's shorter side or longer; where there is no such way,
// down to a twelfth of it, below which it throws Error.
SimulatedHand strokes(std::uint32_t seed, double seconds = 20, double speed = 0.05,
                      const StrokeArea& area = {});

} // namespace patina
