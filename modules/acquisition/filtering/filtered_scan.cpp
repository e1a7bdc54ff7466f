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

// Without what lies outside the time that the camera saw; a clock that jumped may be hours away.
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

std::vector<PathSample> pathWithForce(const CameraTrack& track,
                                      const std::vector<ProbeSample>& samples) {
  std::vector<double> times;
  for (const ProbeSample& sample : samples) times.push_back(sample.t);
  std::vector<PathSample> path = pathAt(track, times);
  for (std::size_t i = 0; i < path.size(); ++i) path[i].force = samples[i].force;
  return path;
}

// Innovations of a rig and a clock that are right stay below 2.5, of gravity .1 rad off they
// are 5.6.
constexpr double kContradiction = 4;
constexpr double kManyRejected = 0.3; // of the poses

std::string rounded(double nis) {
  return std::to_string(std::lround(std::min(nis, 1e9)));
}

void addDoubts(FilteredScan& scan, std::size_t poses) {
  const double rejected = static_cast<double>(poses - scan.track.used());
  if (rejected > kManyRejected * static_cast<double>(poses))
    scan.doubts.push_back(formatCount(poses - scan.track.used()) + " of " + formatCount(poses) +
                          " poses were rejected, and those that are left may be the wrong ones");
  const double axes = *std::max_element(scan.axis_nis.begin(), scan.axis_nis.end());
  if (axes > kContradiction || scan.pose_nis > kContradiction)
    scan.doubts.push_back(
        "accelerometers and poses contradict one another (NIS " + rounded(axes) + " and " +
        rounded(scan.pose_nis) +
        ", 1 is expected): axes or gravity of the rig, units, or the clock are wrong, and so is "
        "the path");
}

} // namespace

FilteredScan filterScan(const std::vector<CameraPose>& poses,
                        const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                        const ScanFilter& filter, Progress& progress) {
  FilteredScan scan;
  if (filter.model == PathModel::fused) {
    FusedOptions options;
    options.gravity = filter.gravity;
    CameraTrack track = firstPass(poses, probe, options);
    scan.clock = fitClock(track, samples, probe, filter.gravity);
    if (!scan.clock)
      scan.doubts.push_back("the probe's clock was not found beside the poses': it is taken to be "
                            "theirs");
    std::vector<ProbeSample> corrected;
    if (scan.clock && scan.clock->differs) {
      corrected = samples;
      for (ProbeSample& sample : corrected) sample.t = scan.clock->onCamera(sample.t);
    }
    if (corrected.empty()) corrected = samples;
    eraseUnseen(corrected, poses, track);
    if (corrected.empty() && !samples.empty() && !track.empty()) throw apart(poses, track, samples);
    FusedPath fused = fuseWith(std::move(track), poses, corrected, probe, options, progress);
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

} // namespace patina
