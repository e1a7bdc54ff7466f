// A marker rig that was made by hand, and how it is waved for its calibration (A31).
#pragma once

#include <random>
#include <vector>

#include "acquisition/simulation/simulated_frames.h"
#include "acquisition/tracking/marker_finder.h"

namespace patina {

struct HandmadeRig {
  double glue = 0;        // deviation of each marker's place along each axis [m]
  double glue_angle = 0;  // deviation of its turn about each axis [rad]
  double print_scale = 1; // size of every printed marker over its nominal size
};
// Returns the markers as they were printed and glued; `nominal` is what was intended.
std::vector<RigMarker> madeByHand(std::vector<RigMarker> nominal, const HandmadeRig& made,
                                  std::uint32_t seed);

// A probe in front of the camera: waved during the first half, then turned about its tip in a
// dimple, and at rest during the last twelfth.
struct WavedProbe {
  Vec3 tip = ProbeModel().tip;
  double seconds = 60;
  double tilt = 0.8;                      // largest tilt of the shaft [rad]
  Vec3 dimple = Vec3(0.01, -0.005, 0.46); // in the camera's frame [m]
  std::uint32_t seed = 1;
};
// Returns camera_from_probe.
Pose wavedPose(const WavedProbe& probe, double t);

// Returns the markers that a tracker would find, without a picture: faces that are turned to the
// camera and lie within the picture, with independent errors of the corners [px].
std::vector<SeenMarker> projectedMarkers(const std::vector<RigMarker>& markers,
                                         const Pose& camera_from_probe, const Camera& camera,
                                         double deviation, std::mt19937& random);

} // namespace patina
