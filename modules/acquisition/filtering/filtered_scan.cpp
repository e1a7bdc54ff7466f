#include "acquisition/filtering/filtered_scan.h"

#include <algorithm>
#include <cmath>

#include "acquisition/filtering/contact.h"
#include "core/decompose.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr std::size_t kMeanOf = 16;      // samples per window, longer than the waves of texture
constexpr std::size_t kCoarse = 200;     // windows in the first search
constexpr double kCoarseStep = 0.01;     // the fit converges from within 7 ms for a quick hand [s]
constexpr double kFarthest = 0.5;        // [s]
constexpr double kDifference = 5e-3;     // time step of numerical derivatives [s]
constexpr double kWorstOffset = 0.02;    // largest accepted deviation of the offset [s]
constexpr double kCorrelationTime = 0.5; // correlation time of the errors [s]
constexpr double kSignificance = 1e-4;   // significance level of clocks that differ

struct Window {
  double t;
  Eigen::Vector4d shown;
};

std::vector<Window> windowsOf(const std::vector<ProbeSample>& samples) {
  std::vector<Window> windows;
  for (std::size_t begin = 0; begin + kMeanOf <= samples.size(); begin += kMeanOf) {
    const ProbeSample &first = samples[begin], &last = samples[begin + kMeanOf - 1];
    if (last.t - first.t > 0.1) continue;
    Window window{0, Eigen::Vector4d::Zero()};
    for (std::size_t i = begin; i < begin + kMeanOf; ++i) {
      window.t += samples[i].t / kMeanOf;
      window.shown += Eigen::Vector4d(samples[i].acceleration.data()) / kMeanOf;
    }
    if (std::isfinite(window.t) && window.shown.allFinite()) windows.push_back(window);
  }
  return windows;
}

class PredictedAcceleration {
 public:
  PredictedAcceleration(const CameraTrack& track, const ProbeModel& probe, const Vec3& gravity)
      : track_(track), probe_(probe), gravity_(gravity) {}

  std::optional<Eigen::Vector4d> at(double t) const {
    const TipMotion motion = motionAt(track_, t);
    if (motion.gap) return std::nullopt;
    const Vec3 held = motion.orientation.conjugate() * (motion.acceleration - gravity_);
    Eigen::Vector4d shown;
    for (int k = 0; k < 4; ++k) {
      const AccelerometerAxis& axis = probe_.axes[static_cast<std::size_t>(k)];
      const Vec3 arm = axis.position - probe_.tip;
      shown[k] = axis.direction.dot(held + motion.rate_of_rate.cross(arm) +
                                    motion.rate.cross(motion.rate.cross(arm)));
    }
    return shown;
  }

 private:
  const CameraTrack& track_;
  const ProbeModel& probe_;
  const Vec3& gravity_;
};

// Returns the mean squared residual for an offset, each axis about its own mean; infinite if fewer
// than half of the windows have poses.
double residualFor(double offset, const std::vector<Window>& windows,
                   const PredictedAcceleration& expected) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero(), squares = Eigen::Vector4d::Zero();
  double count = 0;
  for (const Window& window : windows) {
    const auto value = expected.at(window.t - offset);
    if (!value) continue;
    const Eigen::Vector4d off = window.shown - *value;
    sum += off;
    squares += off.cwiseAbs2();
    count += 1;
  }
  if (2 * count < static_cast<double>(windows.size())) return INFINITY;
  return (squares.sum() - sum.squaredNorm() / count) / count;
}

double coarseOffset(const std::vector<Window>& windows, const PredictedAcceleration& expected) {
  std::vector<Window> few;
  const std::size_t step = std::max<std::size_t>(windows.size() / kCoarse, 1);
  for (std::size_t i = 0; i < windows.size(); i += step) few.push_back(windows[i]);
  double best = 0, least = INFINITY;
  for (double offset = -kFarthest; offset <= kFarthest; offset += kCoarseStep)
    if (const double left = residualFor(offset, few, expected); left < least) {
      least = left;
      best = offset;
    }
  return best;
}

using ClockVector = Eigen::Matrix<double, 6, 1>; // offset, skew, four biases
using ClockSquare = Eigen::Matrix<double, 6, 6>;

// Normal equations about some x.
struct Equations {
  ClockSquare normal = ClockSquare::Zero();
  ClockVector right = ClockVector::Zero();

  void add(const ClockVector& row, double residual) {
    normal += row * row.transpose();
    right += row * residual;
  }
};

struct ClockFit {
  Equations all;
  std::vector<Equations> parts;  // one per half second
  double squares = 0, count = 0; // sum and number of squared residuals
};

ClockFit fitAbout(const ClockVector& x, double start, const std::vector<Window>& windows,
                  const PredictedAcceleration& expected) {
  ClockFit fit;
  double part_end = -INFINITY;
  for (const Window& window : windows) {
    const double since = window.t - start, t = window.t - x[0] - x[1] * since;
    const auto before = expected.at(t - kDifference), now = expected.at(t),
               after = expected.at(t + kDifference);
    if (!before || !now || !after) continue;
    if (window.t > part_end) {
      fit.parts.emplace_back();
      part_end = window.t + kCorrelationTime;
    }
    for (int k = 0; k < 4; ++k) {
      const double rate = ((*after)[k] - (*before)[k]) / (2 * kDifference);
      ClockVector row = ClockVector::Zero();
      row[0] = -rate, row[1] = -rate * since, row[2 + k] = 1;
      const double residual = window.shown[k] - (*now)[k] - x[2 + k];
      fit.all.add(row, residual);
      fit.parts.back().add(row, residual);
      fit.squares += residual * residual;
      fit.count += 1;
    }
  }
  return fit;
}

// Covariance by the jackknife: the scatter of solutions that each leave out one part. It detects a
// solution that depends on a single stroke.
ClockSquare covarianceByParts(const ClockFit& fit, const ClockVector& solution) {
  const double count = static_cast<double>(fit.parts.size());
  ClockVector sum = ClockVector::Zero();
  ClockSquare squares = ClockSquare::Zero();
  for (const Equations& part : fit.parts) {
    const ClockVector moved =
        ClockVector(
            SymmetricSolver(fit.all.normal - part.normal).solve(fit.all.right - part.right)) -
        solution;
    sum += moved;
    squares += moved * moved.transpose();
  }
  return (count - 1) / count * (squares - 1 / count * sum * sum.transpose());
}

} // namespace

std::optional<ProbeClock> fitClock(const CameraTrack& track,
                                   const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                                   const Vec3& gravity) {
  const std::vector<Window> windows = windowsOf(samples);
  if (track.empty() || windows.size() < 30) return std::nullopt;
  const PredictedAcceleration expected(track, probe, gravity);
  ProbeClock clock;
  clock.start = samples.front().t;
  // Gauss-Newton.
  ClockVector x = ClockVector::Zero();
  x[0] = coarseOffset(windows, expected);
  constexpr int kRounds = 6;
  bool settled = false, is_observable = false;
  for (int round = 0; round < kRounds && !settled; ++round) {
    const ClockFit fit = fitAbout(x, clock.start, windows, expected);
    const SymmetricSolver solver(fit.all.normal);
    if (fit.count < 100 || fit.parts.size() < 4 || !(solver.reciprocalCondition() > 1e-12))
      return std::nullopt;
    const ClockVector change = solver.solve(fit.all.right);
    x += change;
    const ClockSquare independent = fit.squares / (fit.count - 6) * ClockSquare(solver.inverse()),
                      correlated = covarianceByParts(fit, change);
    const auto testStatistic = [both = Vec2(x.head<2>())](const ClockSquare& P) {
      return both.dot(P.topLeftCorner<2, 2>().inverse() * both);
    };
    clock.offset = x[0];
    clock.skew = x[1];
    clock.offset_deviation = std::sqrt(std::max(independent(0, 0), correlated(0, 0)));
    clock.skew_deviation = std::sqrt(std::max(independent(1, 1), correlated(1, 1)));
    settled = std::abs(change[0]) < 0.1 * clock.offset_deviation;
    is_observable = std::sqrt(independent(0, 0)) < kWorstOffset;
    // Both tests for two parameters must reject: chi squared and Hotelling's T squared.
    const double free = static_cast<double>(fit.parts.size()) - 1;
    clock.is_significant =
        testStatistic(independent) > -2 * std::log(kSignificance) &&
        testStatistic(correlated) > free * (std::pow(kSignificance, -2 / (free - 1)) - 1);
  }
  const bool found = settled && std::abs(clock.offset) < 1.1 * kFarthest &&
                     std::abs(clock.skew) < 0.02 && is_observable;
  return found ? std::optional(clock) : std::nullopt;
}

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
  if (rejected > kMaxOutlierFraction * static_cast<double>(poses))
    scan.warnings.push_back(formatCount(poses - scan.track.used()) + " of " + formatCount(poses) +
                            " poses were rejected, and those that are left may be the wrong ones");
  const double axes = *std::max_element(scan.axis_nis.begin(), scan.axis_nis.end());
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
    scan.clock = fitClock(track, samples, probe, filter.gravity);
    if (!scan.clock)
      scan.warnings.push_back(
          "the probe's clock was not found beside the poses': it is taken to be "
          "theirs");
    std::vector<ProbeSample> corrected;
    if (scan.clock && scan.clock->is_significant) {
      corrected = samples;
      for (ProbeSample& sample : corrected) sample.t = scan.clock->onCamera(sample.t);
    }
    std::vector<RateSample> turning = rates;
    if (!corrected.empty())
      for (RateSample& rate : turning) rate.t = scan.clock->onCamera(rate.t);
    if (corrected.empty()) corrected = samples;
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
