// The tip's motion from camera poses alone (A06): Kalman filter with gate and re-initialisation,
// and RTS smoother (Rauch, Tung & Striebel 1965), in continuous time.
#pragma once

#include <optional>
#include <vector>

#include "acquisition/filtering/motion_filter.h"
#include "acquisition/values/scan_samples.h"

namespace patina {

// Gap after which the filter restarts [s]; prediction errors grow as t^5.
inline constexpr double kMaxGap = 1.5;

struct CameraTrackOptions {
  bool acceleration = true; // constant acceleration; false: constant velocity
  bool smooth = true;       // RTS smoother; false: filter only
  // Outlier gate: a chi^2 of three degrees of freedom exceeds it once in 10,000.
  double gate = 21.1;
  int restart_after = 5;    // consistent poses outside the gate that start another track
  double longest_gap = 0.1; // larger distances in time to a pose count as a gap [s]
  // Process noise density: white acceleration [m/s^1.5] or jerk [m/s^2.5], and the same for the
  // angle [rad/...]. If absent, it is estimated by maximum likelihood, with larger values for poses
  // where the hand moves more abruptly.
  std::optional<double> position_noise, angle_noise;
};

// Motion at one time. The orientation is camera_from_probe; its rates are in the probe's frame.
struct TipMotion {
  Vec3 position = Vec3::Zero();     // tip [m]
  Vec3 velocity = Vec3::Zero();     // [m/s]
  Vec3 acceleration = Vec3::Zero(); // [m/s^2]; 0 with constant velocity
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Vec3 rate = Vec3::Zero();                   // [rad/s]
  Vec3 rate_of_rate = Vec3::Zero();           // [rad/s^2]; 0 with constant velocity
  double position_noise = 0, angle_noise = 0; // process noise of the track at this time
  double sigma = 0, sigma_angle = 0;          // deviation of each axis [m], [rad]
  bool gap = false;
};

struct CameraTrack {
  template <int N> struct Node {
    using Gain = Eigen::Matrix<double, N, N>;
    double t = 0;
    MotionState<N, 3> tip;
    MotionState<N, 4> turn;                                 // quaternion's components x y z w
    double tip_noise = 0, turn_noise = 0;                   // since the previous node
    bool is_segment_start = false;                          // true at the start of a segment
    Gain tip_gain = Gain::Zero(), turn_gain = Gain::Zero(); // smoother gains to this node
  };
  CameraTrackOptions options; // including the estimated noise
  std::vector<Node<2>> slow;  // one of the two is empty
  std::vector<Node<3>> fast;
  std::vector<PoseVerdict> verdicts; // one per pose
  std::size_t restarts = 0;
  double nis_mean = 0;       // per degree of freedom; estimated noise hides small sigmas
  double rms_innovation = 0; // tip, per axis [m]

  bool empty() const { return slow.empty() && fast.empty(); }
  std::size_t used() const; // number of poses with this verdict
};

// Tracks the tip, which is given in the probe's frame. Poses out of the order of time are left out,
// with a verdict. The track is empty if no pose is usable.
CameraTrack trackTip(const std::vector<CameraPose>& poses, const Vec3& tip,
                     const CameraTrackOptions& options = {});

// Interpolates at any time; throws std::invalid_argument for an empty track. Outside the poses and
// in gaps the motion is predicted and sigma grows.
TipMotion motionAt(const CameraTrack& track, double t);
std::vector<PathSample> pathAt(const CameraTrack& track, const std::vector<double>& times);

} // namespace patina
