// Offset of the probe's clock from the camera's, estimated from the common motion (A06).
#pragma once

#include <optional>
#include <string>

#include "acquisition/filtering/fused_path.h"

namespace patina {

// A stamp t of the probe is t - offset - skew (t - start) on the camera's clock.
struct ProbeClock {
  double start = 0, offset = 0; // [s]
  double skew = 0;              // relative excess rate of the probe's clock
  double offset_deviation = 0, skew_deviation = 0;
  bool is_significant = false; // offset or skew are statistically significant
  // Standard deviation of the offset in the middle of the recording [s].
  double deviation = 0;
  bool isKnown() const { return deviation <= 1e-3; }
  // Delay of the gyroscope behind the accelerometers, by its filter; 0 if insignificant [s].
  double gyroscope_delay = 0;

  double onCamera(double t) const { return t - offset - skew * (t - start); }
  // Returns the camera's time of a stamp of the gyroscope.
  double ofGyroscope(double t) const {
    return (is_significant ? onCamera(t) : t) - gyroscope_delay;
  }
};

struct ClockFit {
  std::optional<ProbeClock> clock; // nullopt: unknown
  std::string doubt;               // for the user: why it is unknown or inaccurate; else empty
};

// Maximises the likelihood of poses and readings by the fused path's filter. Finds offsets up to
// half a second. The clock is unknown if the probe hardly rotates or moves while it is tracked, or
// if two offsets fit. Samples and rates are in the order of time; the latter are empty without a
// gyroscope. Throws Cancelled.
ClockFit fitClock(const CameraTrack& track, const std::vector<CameraPose>& poses,
                  const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                  const FusedOptions& options, Progress& progress,
                  const std::vector<RateSample>& rates = {});

} // namespace patina
