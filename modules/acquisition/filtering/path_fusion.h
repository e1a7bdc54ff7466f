// Working state of the fused path's passes (A06): the weights of the poses, the noise and the
// motion about which a pass is linearised get better in each.
#pragma once

#include <initializer_list>

#include "acquisition/filtering/fused_path.h"
#include "acquisition/filtering/fusion_pass.h"

namespace patina {

// An innovation over its deviation, and its derivatives by the offset of the probe's clock [1/s],
// by its skew about a time and by the gyroscope's delay [1/s].
struct ClockInnovation {
  double t = 0; // [s]
  double value = 0;
  Vec3 growth = Vec3::Zero();
};

class PathFusion {
 public:
  // Refers to track, poses, probe and progress, which must stay; `windows` are meansOverWindows().
  PathFusion(const CameraTrack& track, const std::vector<CameraPose>& poses,
             std::vector<InertialReading> windows, const ProbeModel& probe,
             const FusedOptions& options, Progress& progress);

  // Weighs each pose by its innovation in the better one of both directions of time, since a pose
  // beside a gap cannot be tested from one side.
  void weighBothWays();
  // Smooths the means over windows, weighs the poses and linearises about the result. Returns true
  // if the outliers are others than before: one that was lost may have hidden another one.
  bool refine();
  void forgetWeights() { weights_ = first_weights_; }
  // Chooses the factor of a sensor's variance by the likelihood of the poses.
  void chooseVariance(double FusionScales::*factor, std::initializer_list<double> factors);
  // Fits the gyroscope's scale factors and axes to the poses and corrects its rates.
  void fitGyroscope();
  // Chooses the process noise of each few poses by their likelihood: a hand that rests needs less
  // than one that taps. An interval gets the largest noise of its neighbours, too.
  void chooseNoise();

  bool isOutlier(std::size_t i) const { return weights_[i] < 2 * kRejected; }
  FusionScales scales() const { return scales_; }
  void setScales(const FusionScales& scales) { scales_ = scales; }
  // Returns -2 log likelihood of the poses; outliers count only so much.
  double deviance();
  // Returns the innovations of poses and readings and their derivatives; the skew is about `middle`
  // [s].
  std::vector<ClockInnovation> clockInnovations(double middle);
  // Smooths all readings; writes path, biases and innovations.
  void writeTo(FusedPath& fused, std::vector<InertialReading> readings);

 private:
  void writeInnovations(FusedPath& fused, const std::vector<InertialReading>& readings);
  bool weigh();
  std::vector<double> devianceOfPoses(const std::vector<NoiseInterval>& noise,
                                      const FusionScales& scales, bool cross);

  static constexpr double kRejected = 1e-4; // weight of an outlier, which a pass may take back

  const CameraTrack& track_;
  std::vector<InertialReading> windows_;
  Eigen::Matrix3d rate_correction_ = Eigen::Matrix3d::Identity(); // true rate over the reading's
  std::vector<double> starts_;
  ReferenceMotion reference_;
  std::vector<double> weights_, first_weights_;
  std::vector<PoseScore> scores_;
  FusionInput input_;
  FusionScales scales_;
  std::vector<NoiseInterval> noise_;
  Progress& progress_;
};

} // namespace patina
