#include "acquisition/filtering/fused_path.h"

#include <algorithm>
#include <cmath>

#include "acquisition/filtering/fusion_readings.h"
#include "acquisition/filtering/path_fusion.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr int kOutlierRounds = 6; // maximum number of passes; the outliers then rarely change

// Marks samples far from any used pose.
void markGaps(std::vector<PathSample>& path, const std::vector<CameraPose>& poses,
              const CameraTrack& track) {
  std::vector<double> seen;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (track.verdicts[i] == PoseVerdict::used) seen.push_back(poses[i].t);
  const double longest = track.options.longest_gap;
  for (PathSample& sample : path) {
    const auto after = std::lower_bound(seen.begin(), seen.end(), sample.t);
    if (after != seen.end() && *after == sample.t) continue;
    const bool inside = after != seen.begin() && after != seen.end();
    sample.gap = seen.empty() ||
                 (inside ? *after - *(after - 1) > longest
                         : std::abs(sample.t - (after == seen.end() ? seen.back() : seen.front())) >
                               longest);
  }
}

} // namespace

CameraTrack firstPass(const std::vector<CameraPose>& poses, const ProbeModel& probe,
                      const FusedOptions& options) {
  CameraTrackOptions first = options.camera;
  first.acceleration = true;
  first.smooth = true;
  return trackTip(poses, probe.tip, first);
}

FusedPath fuseWith(CameraTrack track, const std::vector<CameraPose>& poses,
                   const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                   const FusedOptions& options, Progress& progress,
                   const std::vector<RateSample>& rates) {
  FusedPath fused;
  fused.track = std::move(track);
  if (fused.track.empty()) return fused;
  const std::vector<InertialReading> readings = inertialReadings(samples, rates, probe);
  PathFusion fusion(fused.track, poses, meansOverWindows(readings), probe, options, progress);
  progress.report(0.1, "filter");
  fusion.weighBothWays();
  fusion.refine();
  fusion.forgetWeights();
  const auto chooseVariances = [&] {
    if (!rates.empty()) fusion.chooseVariance(&FusionScales::rate, {1, 10, 100, 1000});
    fusion.chooseVariance(&FusionScales::acceleration, {1, 4, 16, 64, 256});
  };
  chooseVariances();
  if (!rates.empty()) {
    fusion.weighBothWays();
    fusion.refine();
    fusion.fitGyroscope();
    fusion.refine();
    fusion.forgetWeights();
    chooseVariances();
  }
  fusion.chooseNoise();
  fusion.weighBothWays();
  for (int round = 0; round < kOutlierRounds && fusion.refine(); ++round) continue;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (fused.track.verdicts[i] == PoseVerdict::used ||
        fused.track.verdicts[i] == PoseVerdict::outlier)
      fused.track.verdicts[i] = fusion.isOutlier(i) ? PoseVerdict::outlier : PoseVerdict::used;
  progress.report(0.4, "smoother");
  fused.path.reserve(samples.size());
  fusion.writeTo(fused, readings);
  markGaps(fused.path, poses, fused.track);
  for (const PathSample& sample : fused.path)
    if (!sample.position.allFinite() || !(sample.sigma >= 0) || !std::isfinite(sample.sigma))
      throw Error("the filter has no result at " + formatNumber(sample.t) +
                  " s: poses and probe are too far apart in time or position");
  return fused;
}

FusedPath fusePath(const std::vector<CameraPose>& poses, const std::vector<ProbeSample>& samples,
                   const ProbeModel& probe, const FusedOptions& options,
                   const std::vector<RateSample>& rates) {
  Progress progress;
  return fuseWith(firstPass(poses, probe, options), poses, samples, probe, options, progress,
                  rates);
}

} // namespace patina
