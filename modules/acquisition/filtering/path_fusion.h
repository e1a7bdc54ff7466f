// Working state of the fused path's passes (A06): the weights of the poses, the noise and the
// motion about which a pass is linearised get better in each.
#pragma once

#include <initializer_list>

#include "acquisition/filtering/fused_path.h"
#include "acquisition/filtering/fusion_pass.h"

namespace patina {

class PathFusion {
 public:
  // Refers to track, poses, probe and progress, which must stay; `windows` are meansOverWindows().
  PathFusion(const CameraTrack& track, const std::vector<CameraPose>& poses,
             std::vector<InertialReading> windows, const ProbeModel& probe,
             const FusedOptions& options, Progress& progress);

  // Weighs each pose by its innovation in the better one of both directions of time, since a pose
  // beside a gap cannot be tested from one side.
  void weighBothWays();
  // Smooths the means over windows, weighs the poses and linearises about the result.
  void refine();
  void forgetWeights() { weights_ = first_weights_; }
  // Chooses the factor of a sensor's variance by the likelihood of the poses.
  void chooseVariance(double FusionScales::*factor, std::initializer_list<double> factors);
  // Chooses the process noise of each few poses by their likelihood: a hand that rests needs less
  // than one that taps. An interval gets the largest noise of its neighbours, too.
  void chooseNoise();

  // Returns true if pose i is an outlier: a chi^2 of six degrees of freedom exceeds the limit once
  // in 2 million.
  bool isOutlier(std::size_t i) const { return scores_[i].nis > 40; }
  // Smooths all readings; writes path, biases and innovations.
  void writeTo(FusedPath& fused, const std::vector<InertialReading>& readings);

 private:
  void writeInnovations(FusedPath& fused, const std::vector<InertialReading>& readings);
  void weigh();
  std::vector<double> devianceOfPoses(const std::vector<NoiseInterval>& noise,
                                      const FusionScales& scales, bool cross);

  const CameraTrack& track_;
  std::vector<InertialReading> windows_;
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
