// One pass of the fused path's filter over camera and probe (A06). The path is linearised about a
// reference motion, so that a second pass about the first one's result is an iterated Kalman
// smoother (Bell 1994).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "acquisition/filtering/camera_track.h"
#include "acquisition/filtering/error_state.h"

namespace patina {

// Convert a rotation to its axis times its angle [rad], and back.
Vec3 rotationVector(const Eigen::Quaterniond& rotation);
Eigen::Quaterniond rotationOf(const Vec3& vector);

// Readings of the probe at one time, or their means over a window.
struct InertialReading {
  double t = 0;                         // [s]
  std::array<double, 4> acceleration{}; // [m/s^2]
  double acceleration_variance = 0;     // one an axis
  Vec3 rate = Vec3::Zero();             // [rad/s]
  double rate_variance = 0;
  bool has_acceleration = false, has_rate = false;
  Vec3 jerk = Vec3::Zero();     // process noise density in the probe's frame [m^2/s^5]
  double velocity_variance = 0; // process noise of the velocity, by a peak of the acceleration
  double force = 0;             // [N]
  bool is_sample = false;       // the path has a sample at this time
};

// Motion about which a pass is linearised: the camera's track, or nodes of an earlier pass.
class ReferenceMotion {
 public:
  // Refers to the track, which must stay. The nodes are in the order of time and may be empty.
  explicit ReferenceMotion(const CameraTrack& track, std::vector<double> times = {},
                           std::vector<TipMotion> nodes = {})
      : track_(&track), times_(std::move(times)), nodes_(std::move(nodes)) {}
  TipMotion at(double t) const;

 private:
  const CameraTrack* track_;
  std::vector<double> times_;
  std::vector<TipMotion> nodes_;
};

struct FusionEvent {
  TipMotion reference;
  double t = 0;
  std::ptrdiff_t reading = -1, pose = -1; // one of the two is set
  bool is_segment_start = false;
  double angle_scale = 1, jerk_scale = 1; // densities of the process noise since the last event
};

// Scale factors of the sensors' variances.
struct FusionScales {
  double acceleration = 1, rate = 1;
};

// Scale factors of the process noise densities up to a time [s].
struct NoiseInterval {
  double until = 0, angle = 1, jerk = 1;
};

struct FusionInput {
  const std::vector<CameraPose>& poses;
  const std::vector<double>& weights; // one a pose; 0: the pose is left out
  const ProbeModel& probe;
  Vec3 gravity = Vec3::Zero();
  double bias = 0, rate_bias = 0; // prior deviations [m/s^2], [rad/s]
};

// Returns the events of readings and of poses with a weight in the order of time. `starts` are the
// times at which the track begins a segment; the last interval of the noise has no end.
std::vector<FusionEvent> fusionEvents(const std::vector<InertialReading>& readings,
                                      const FusionInput& input, const std::vector<double>& starts,
                                      const ReferenceMotion& reference,
                                      const std::vector<NoiseInterval>& noise);

// One step of the forward pass, as the backward pass needs it.
struct FusionStep {
  double dt = 0;
  std::array<ProcessedRow, 7> used;
  std::size_t count = 0;
  ErrorState state; // after the measurements
  double pose_variance =
      1; // factor of the pose's variance, above 1 if its innovation was too large
  double pose_deviance = 0; // -2 log likelihood of a softened pose, which may be an outlier
};

class FusionPass {
 public:
  FusionPass(const std::vector<FusionEvent>& events, const std::vector<InertialReading>& readings,
             const FusionInput& input, const FusionScales& scales)
      : events_(events), readings_(readings), input_(input), scales_(scales) {}

  // Inflates the variance of poses whose innovation is too large, so that none is thrown away.
  void softenPoses() { soft_ = true; }
  // Filters event k; k = 0 starts.
  void advance(ErrorState& state, std::size_t k, FusionStep& step) const;

  // Filters forwards; `visit` gets each step. Then smooths backwards; `smoothed` gets each event,
  // its step and the backward variables before its own measurements.
  using Visit = std::function<void(std::size_t, const FusionStep&)>;
  using Smoothed = std::function<void(std::size_t, const FusionStep&, const BrysonFrazierState&)>;
  void run(const Visit& visit, const Smoothed& smoothed, class Progress& progress) const;

 private:
  void begin(ErrorState& state, const TipMotion& reference, bool first) const;
  void useReading(ErrorState& state, std::size_t k, FusionStep& step) const;
  void usePose(ErrorState& state, std::size_t k, FusionStep& step) const;

  const std::vector<FusionEvent>& events_;
  const std::vector<InertialReading>& readings_;
  const FusionInput& input_;
  FusionScales scales_;
  bool soft_ = false;
};

// Measurement of a pose about a reference: residual of the angle and of the tip, with rows.
struct PoseRows {
  Eigen::Matrix<double, 6, 1> measured, variance;
  std::array<MeasurementRow, 6> row;
};
PoseRows poseRows(const CameraPose& pose, const TipMotion& reference, const Vec3& tip);

// Returns the smoothed motion at an event.
TipMotion smoothedMotion(const FusionEvent& event, const FusionStep& step,
                         const BrysonFrazierState& adjoint);

// Verdict of all other measurements on a pose.
struct PoseScore {
  double weight = 1; // Student's t with four degrees of freedom (Piche, Sarkka & Hartikainen 2012)
  double nis = 0;    // squared residual over its variance without this pose, 6 degrees of freedom
  double volume = 0; // logarithm of the determinant of that variance over the pose's own
};
PoseScore scoreOf(const CameraPose& pose, double variance_factor, const FusionEvent& event,
                  const FusionStep& step, const BrysonFrazierState& adjoint, const Vec3& tip);

} // namespace patina
