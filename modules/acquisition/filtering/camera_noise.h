// How restless the hand is that holds the probe (A06): the noise of a track's motion.
#pragma once

#include "acquisition/filtering/camera_track.h"

namespace patina {

inline constexpr double kFastestTip = 0.3; // [m/s], to begin with
inline constexpr double kFastestTurn = 1;  // of a quaternion's component [1/s]

// What a pose says of tip and orientation, a quaternion x y z w.
struct MeasuredPose {
  double t; // [s]
  Eigen::Matrix<double, 1, 3> tip;
  Eigen::Matrix<double, 1, 4> turn;
  double tip_variance, turn_variance; // of each component
  // Densities of what disturbs the motion on the way here, as CameraTrackOptions has them; turn: of
  // the quaternion's components.
  double tip_noise = 0, turn_noise = 0;
};

// Sets the noise of each pose that is used, and that of the options where it is absent: the usual
// one is where all poses are likeliest; a few poses have more where that is clearly likelier. N =
// 2: constant velocity; 3: acceleration.
template <int N>
void findNoise(std::vector<MeasuredPose>& measured, const std::vector<PoseVerdict>& verdicts,
               CameraTrackOptions& options);

} // namespace patina
