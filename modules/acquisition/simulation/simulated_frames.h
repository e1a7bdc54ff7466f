// The frames that a camera would take of a simulated hand's probe (A04).
#pragma once

#include "acquisition/scan_samples.h"
#include "acquisition/simulation/frame_renderer.h"
#include "acquisition/simulation/simulated_hand.h"

namespace patina {

// A cube about the probe's origin with markers 0 to 4 of a family on all faces but the one towards
// the tip, each face a margin of one bit wide. `edge` [m].
std::vector<RigMarker> markerCube(const std::string& family, int side, double edge);

struct FrameCourse {
  Pose camera_from_world = Pose::Identity();
  double rate = 30;         // [Hz]
  double exposure = 4e-3;   // around each frame's time: what moves meanwhile is blurred [s]
  std::vector<Gap> covered; // times in which something is before the markers
  FrameLook look;
  std::uint32_t seed = 1;
};

int frameCount(const SimulatedHand& hand, const FrameCourse& course);
// Frame i, at the time i / rate.
GreyFrame frameAt(const FrameRenderer& renderer, const SimulatedHand& hand, const ProbeModel& probe,
                  const FrameCourse& course, int i);

} // namespace patina
