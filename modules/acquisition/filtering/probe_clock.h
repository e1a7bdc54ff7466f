// The probe's clock against the camera's, from what both know of the motion.
#pragma once

#include <optional>

#include "acquisition/filtering/camera_track.h"

namespace patina {

// A stamp t of the probe is t - offset - skew (t - start) on the camera's clock.
struct ProbeClock {
  double start = 0, offset = 0; // [s]
  double skew = 0;              // by how much it runs faster
  double offset_deviation = 0, skew_deviation = 0;
  // Beyond what chance makes of clocks that agree.
  bool differs = false;

  double onCamera(double t) const { return t - offset - skew * (t - start); }
};

// What the accelerometers show against what the camera's smoothed track lets expect: gravity by the
// probe's tilt, and the hand's own accelerations. Offsets up to half a second are found; nullopt
// where the probe hardly turns or moves while it is seen. Samples in the order of their time.
std::optional<ProbeClock> fitClock(const CameraTrack& track,
                                   const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                                   const Vec3& gravity);

} // namespace patina
