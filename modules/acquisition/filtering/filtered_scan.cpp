#include "acquisition/filtering/filtered_scan.h"

#include <algorithm>
#include <cmath>

#include "acquisition/filtering/contact.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

std::vector<Gap> gapsIn(const std::vector<double>& times, double longest) {
  std::vector<Gap> gaps;
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] - times[i - 1] > longest) gaps.push_back({times[i - 1], times[i]});
  return gaps;
}

std::vector<double> timesOfUsed(const std::vector<CameraPose>& poses, const CameraTrack& track) {
  std::vector<double> times;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (track.verdicts[i] == PoseVerdict::used) times.push_back(poses[i].t);
  return times;
}

// Removes samples outside the poses' times, hours away if a clock jumped.
template <class Sample>
void eraseUnseen(std::vector<Sample>& samples, const std::vector<CameraPose>& poses,
                 const CameraTrack& track) {
  const std::vector<double> seen = timesOfUsed(poses, track);
  const double longest = track.options.longest_gap;
  std::erase_if(samples, [&](const Sample& sample) {
    return seen.empty() ||
           !(sample.t >= seen.front() - longest && sample.t <= seen.back() + longest);
  });
}

Error apart(const std::vector<CameraPose>& poses, const CameraTrack& track,
            const std::vector<ProbeSample>& samples) {
  const std::vector<double> seen = timesOfUsed(poses, track);
  return Error("poses and probe have no time in common: from " + formatNumber(seen.front()) +
               " to " + formatNumber(seen.back()) + " s and from " +
               formatNumber(samples.front().t) + " to " + formatNumber(samples.back().t) + " s");
}

// Throws Error if every pose was rejected, so that nothing holds the path.
void requireUsedPose(const std::vector<CameraPose>& poses, const CameraTrack& track) {
  if (!track.empty() && track.used() == 0)
    throw Error("all " + formatCount(poses.size()) +
                " poses were rejected: they contradict one another");
}

std::vector<PathSample> pathWithForce(const CameraTrack& track,
                                      const std::vector<ProbeSample>& samples) {
  std::vector<double> times;
  for (const ProbeSample& sample : samples) times.push_back(sample.t);
  std::vector<PathSample> path = pathAt(track, times);
  for (std::size_t i = 0; i < path.size(); ++i) path[i].force = samples[i].force;
  return path;
}

// The mean NIS stays below 2.5 if rig and clock are right; gravity .1 rad off makes it 5.6.
constexpr double kMaxNis = 4;
constexpr double kMaxOutlierFraction = 0.3; // largest accepted share of rejected poses

std::string rounded(double nis) {
  return std::to_string(std::lround(std::min(nis, 1e9)));
}

void addDoubts(FilteredScan& scan, std::size_t poses) {
  const double rejected = static_cast<double>(poses - scan.track.used());
  const bool contradict = rejected > kMaxOutlierFraction * static_cast<double>(poses);
  if (contradict)
    scan.warnings.push_back(formatCount(poses - scan.track.used()) + " of " + formatCount(poses) +
                            " poses were rejected, and those that are left may be the wrong ones");
  const double axes = *std::max_element(scan.axis_nis.begin(), scan.axis_nis.end());
  scan.is_wrong = contradict || axes > kMaxNis || scan.pose_nis > kMaxNis;
  if (axes > kMaxNis || scan.pose_nis > kMaxNis)
    scan.warnings.push_back(
        "accelerometers and poses contradict one another (NIS " + rounded(axes) + " and " +
        rounded(scan.pose_nis) +
        ", 1 is expected): axes or gravity of the rig, units, or the clock are wrong, and so is "
        "the path");
}

// Raises the deviations of a path to those of the poses about it.
void coverSharedErrors(std::vector<PathSample>& path, const std::vector<CameraPose>& poses,
                       const Vec3& tip) {
  if (poses.empty()) return;
  std::size_t near = 0;
  for (PathSample& sample : path) {
    while (near + 1 < poses.size() &&
           !(std::abs(poses[near + 1].t - sample.t) > std::abs(poses[near].t - sample.t)))
      ++near;
    const CameraPose& pose = poses[near];
    const double angle = pose.sigma_angle * pose.sigma_angle;
    const double place =
        pose.sigma_position * pose.sigma_position + 2. / 3 * angle * tip.squaredNorm();
    sample.sigma = std::max(sample.sigma, std::sqrt(place));
    sample.sigma_angle = std::max(sample.sigma_angle, pose.sigma_angle);
  }
}

FilteredScan filteredStreams(const std::vector<CameraPose>& poses,
                             const std::vector<ProbeSample>& samples,
                             const std::vector<RateSample>& rates, const ProbeModel& probe,
                             const ScanFilter& filter, Progress& progress) {
  FilteredScan scan;
  if (filter.model == PathModel::fused) {
    FusedOptions options;
    options.gravity = filter.gravity;
    CameraTrack track = firstPass(poses, probe, options);
    requireUsedPose(poses, track);
    ClockFit clock = fitClock(track, poses, samples, probe, options, progress, rates);
    if (!clock.doubt.empty()) scan.warnings.push_back(std::move(clock.doubt));
    if (clock.clock && (clock.clock->isKnown() || clock.clock->is_significant))
      scan.clock = clock.clock;
    std::vector<ProbeSample> corrected = samples;
    std::vector<RateSample> turning = rates;
    if (clock.clock && clock.clock->is_significant)
      for (ProbeSample& sample : corrected) sample.t = clock.clock->onCamera(sample.t);
    if (clock.clock)
      for (RateSample& rate : turning) rate.t = clock.clock->ofGyroscope(rate.t);
    eraseUnseen(turning, poses, track);
    eraseUnseen(corrected, poses, track);
    if (corrected.empty() && !samples.empty() && !track.empty()) throw apart(poses, track, samples);
    FusedPath fused =
        fuseWith(std::move(track), poses, corrected, probe, options, progress, turning);
    scan.path = fused.path;
    scan.whole = std::move(fused.path);
    markContact(scan.whole);
    scan.samples = std::move(corrected);
    scan.track = std::move(fused.track);
    scan.bias = fused.bias;
    scan.axis_nis = fused.axis_nis;
    scan.pose_nis = fused.pose_nis;
  } else {
    CameraTrackOptions options;
    options.acceleration = filter.model == PathModel::acceleration;
    options.smooth = filter.smooth;
    scan.track = trackTip(poses, probe.tip, options);
    if (!scan.track.empty()) scan.path = pathWithForce(scan.track, samples);
  }
  if (scan.track.empty()) return scan;
  requireUsedPose(poses, scan.track);
  addDoubts(scan, poses.size());
  const std::vector<double> seen = timesOfUsed(poses, scan.track);
  const double longest = scan.track.options.longest_gap;
  scan.without_pose = gapsIn(seen, longest);
  if (samples.empty()) {
    scan.path = pathAt(scan.track, seen);
    return scan;
  }
  eraseUnseen(scan.path, poses, scan.track);
  if (scan.path.empty()) throw apart(poses, scan.track, samples);
  std::vector<double> sampled;
  for (const PathSample& sample : scan.path) {
    sampled.push_back(sample.t);
    scan.largest_force = std::max(scan.largest_force, sample.force);
  }
  scan.without_sample = gapsIn(sampled, filter.longest_pause);
  markContact(scan.path);
  if (filter.touching_only)
    std::erase_if(scan.path, [](const PathSample& sample) { return !sample.touching; });
  return scan;
}

} // namespace

FilteredScan filterScan(const std::vector<CameraPose>& poses,
                        const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                        const ScanFilter& filter, Progress& progress,
                        const std::vector<RateSample>& rates) {
  FilteredScan scan = filteredStreams(poses, samples, rates, probe, filter, progress);
  if (std::any_of(poses.begin(), poses.end(),
                  [](const CameraPose& pose) { return pose.rig_doubted; }))
    coverSharedErrors(scan.path, poses, probe.tip);
  return scan;
}

} // namespace patina
