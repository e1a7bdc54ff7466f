// The tip's motion from camera poses alone (A06): Kalman filter with gate and re-initialisation,
// RTS smoother, in continuous time.
#pragma once

#include <optional>
#include <vector>

#include "acquisition/filtering/motion_filter.h"
#include "acquisition/scan_samples.h"

namespace patina {

// A track that sees nothing for longer begins anew [s]: errors that grow as t^5 leave no digits of
// what the next pose says.
inline constexpr double kUnseen = 1.5;

struct CameraTrackOptions {
  bool acceleration = true; // constant acceleration; else constant velocity
  bool smooth = true;       // RTS; else what was known at the time
  // Poses beyond this are outliers; chi^2 of three degrees of freedom exceeds it once in 10,000.
  double gate = 21.1;
  int restart_after = 5; // poses in a row that disagree with the track and agree with one another
  double longest_gap = 0.1; // farther from poses the path counts as a gap [s]
  // Density of what disturbs the motion: white acceleration [m/s^1.5] or jerk [m/s^2.5], and the
  // same for the angle [rad/...]. Absent: where the poses themselves are likeliest, and for a few
  // poses more than that where the hand is less calm than it usually is.
  std::optional<double> position_noise, angle_noise;
};

// Motion at one time. Orientation is camera_from_probe; its rates are in the probe's frame.
struct TipMotion {
  Vec3 position = Vec3::Zero();     // of the tip [m]
  Vec3 velocity = Vec3::Zero();     // [m/s]
  Vec3 acceleration = Vec3::Zero(); // [m/s^2]; 0 with constant velocity
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Vec3 rate = Vec3::Zero();                   // [rad/s]
  Vec3 rate_of_rate = Vec3::Zero();           // [rad/s^2]; 0 with constant velocity
  double position_noise = 0, angle_noise = 0; // that the track has here
  double sigma = 0, sigma_angle = 0;          // of each axis [m], [rad]
  bool gap = false;
};

struct CameraTrack {
  template <int N> struct Node {
    using Gain = Eigen::Matrix<double, N, N>;
    double t = 0;
    MotionState<N, 3> tip;
    MotionState<N, 4> turn;               // the quaternion's components x y z w
    double tip_noise = 0, turn_noise = 0; // on the way here, turn: of the quaternion
    bool starts = false;                  // nothing leads here from the node before
    Gain tip_gain = Gain::Zero(), turn_gain = Gain::Zero(); // of the smoother's step back to here
  };
  CameraTrackOptions options; // with the noise that was found
  std::vector<Node<2>> slow;  // one of the two is empty
  std::vector<Node<3>> fast;
  std::vector<PoseVerdict> verdicts; // of each pose
  std::size_t restarts = 0;
  double nis_mean = 0; // of the poses that were used, per degree of freedom; noise that was found
                       // hides sigmas that are too small
  double rms_innovation = 0; // of the tip, per axis [m]

  bool empty() const { return slow.empty() && fast.empty(); }
  std::size_t used() const { return slow.size() + fast.size(); }
};

// Poses in the order of their time; those that are not are left out and say so. `tip` is in the
// probe's frame. Without a usable pose the track is empty.
CameraTrack trackTip(const std::vector<CameraPose>& poses, const Vec3& tip,
                     const CameraTrackOptions& options = {});

// At any time; throws std::invalid_argument for an empty track. Outside of the poses, and in gaps,
// motion goes on as the model has it and sigma grows.
TipMotion motionAt(const CameraTrack& track, double t);
std::vector<PathSample> pathAt(const CameraTrack& track, const std::vector<double>& times);

} // namespace patina
