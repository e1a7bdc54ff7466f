#include "acquisition/filtering/probe_clock.h"

#include <algorithm>
#include <cmath>

#include "acquisition/filtering/fusion_readings.h"
#include "acquisition/filtering/path_fusion.h"
#include "core/decompose.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kCoarseStep = 0.01;     // the fit converges from within 10 ms [s]
constexpr double kFarthest = 0.5;        // [s]
constexpr std::size_t kCoarseMean = 4;   // windows, longer than the waves of texture
constexpr std::size_t kCoarse = 200;     // means in the first search
constexpr std::size_t kCandidates = 6;   // offsets whose likelihood is compared
constexpr double kWorstOffset = 0.02;    // largest accepted deviation of the offset [s]
constexpr double kCorrelationTime = 0.5; // correlation time of the errors [s]
constexpr double kSignificance = 1e-4;   // significance level of clocks that differ
constexpr double kSkew = 3e-4;           // prior deviation, of two quartz clocks
constexpr double kFarOff = 10;           // deviations of a clock that is far off
constexpr double kGyroscopeDelay = 5e-3; // prior deviation [s]
constexpr double kClearlyDelayed = 4;    // deviations of a significant delay
constexpr int kRounds = 10;
constexpr double kMaxRatio = 0.7; // largest ratio of two steps that is extrapolated
constexpr double kHopeless = 300; // no fit lowers the deviance of its start by more
constexpr double kClearly = 30;   // difference of the deviance of clearly different fits

using Accelerations = Eigen::Vector4d;

struct AccelerationMean {
  double t;
  Accelerations shown;
};

// Returns means over windows, of which about kCoarse are kept.
std::vector<AccelerationMean> coarseMeans(const std::vector<InertialReading>& windows) {
  std::vector<AccelerationMean> means;
  const std::size_t step = std::max(windows.size() / kCoarse, kCoarseMean);
  for (std::size_t begin = 0; begin + kCoarseMean <= windows.size(); begin += step) {
    AccelerationMean mean{0, Accelerations::Zero()};
    double count = 0;
    for (std::size_t i = begin; i < begin + kCoarseMean; ++i) {
      if (!windows[i].has_acceleration || windows[i].t - windows[begin].t > 0.1) continue;
      mean.t += windows[i].t;
      mean.shown += Accelerations(windows[i].acceleration.data());
      count += 1;
    }
    if (count > 0) means.push_back({mean.t / count, mean.shown / count});
  }
  return means;
}

// Returns the accelerations that the camera's smoothed track predicts.
std::optional<Accelerations> predictedAccelerations(const CameraTrack& track,
                                                    const ProbeModel& probe, const Vec3& gravity,
                                                    double t) {
  const TipMotion motion = motionAt(track, t);
  if (motion.gap) return std::nullopt;
  const Vec3 held = motion.orientation.conjugate() * (motion.acceleration - gravity);
  Accelerations shown;
  for (int k = 0; k < 4; ++k) {
    const AccelerometerAxis& axis = probe.axes[static_cast<std::size_t>(k)];
    const Vec3 arm = axis.position - probe.tip;
    shown[k] = axis.direction.dot(held + motion.rate_of_rate.cross(arm) +
                                  motion.rate.cross(motion.rate.cross(arm)));
  }
  return shown;
}

// Returns the mean absolute residual for an offset, each axis about its own median, which outliers
// of the track hardly change; infinite if fewer than half of the means have poses.
double coarseResidual(const std::vector<AccelerationMean>& means, const CameraTrack& track,
                      const ProbeModel& probe, const Vec3& gravity, double offset) {
  std::array<std::vector<double>, 4> off;
  for (const AccelerationMean& mean : means)
    if (const auto expected = predictedAccelerations(track, probe, gravity, mean.t - offset))
      for (int k = 0; k < 4; ++k)
        off[static_cast<std::size_t>(k)].push_back(mean.shown[k] - (*expected)[k]);
  if (2 * off[0].size() < means.size() || off[0].empty()) return INFINITY;
  double sum = 0;
  for (std::vector<double>& axis : off) {
    const auto middle = axis.begin() + static_cast<std::ptrdiff_t>(axis.size() / 2);
    std::nth_element(axis.begin(), middle, axis.end());
    const double median = *middle;
    for (const double each : axis) sum += std::abs(each - median);
  }
  return sum / static_cast<double>(4 * off[0].size());
}

// Returns the minima of the residual, the lowest first.
std::vector<double> coarseOffsets(const std::vector<InertialReading>& windows,
                                  const CameraTrack& track, const ProbeModel& probe,
                                  const Vec3& gravity) {
  const std::vector<AccelerationMean> means = coarseMeans(windows);
  std::vector<double> residuals;
  const int steps = static_cast<int>(std::lround(kFarthest / kCoarseStep));
  for (int i = -steps; i <= steps; ++i)
    residuals.push_back(coarseResidual(means, track, probe, gravity, i * kCoarseStep));
  std::vector<std::pair<double, double>> minima; // residual and offset
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double before = i > 0 ? residuals[i - 1] : INFINITY,
                 after = i + 1 < residuals.size() ? residuals[i + 1] : INFINITY;
    if (std::isfinite(residuals[i]) && residuals[i] <= before && residuals[i] < after)
      minima.emplace_back(residuals[i], (static_cast<int>(i) - steps) * kCoarseStep);
  }
  std::sort(minima.begin(), minima.end());
  std::vector<double> offsets;
  for (const auto& [residual, offset] : minima)
    if (offsets.size() < kCandidates) offsets.push_back(offset);
  return offsets;
}

using ClockVector = Vec3; // offset in the middle, skew, delay of the gyroscope
using ClockSquare = Eigen::Matrix3d;

// Normal equations about some x.
struct ClockEquations {
  ClockSquare normal = ClockSquare::Zero();
  ClockVector right = ClockVector::Zero();

  void add(const ClockInnovation& innovation) {
    normal += innovation.growth * innovation.growth.transpose();
    right += innovation.growth * innovation.value;
  }
};

struct ClockStep {
  ClockEquations all;
  std::vector<ClockEquations> parts; // one per half second
  double count = 0;                  // number of innovations
};

// Covariance by the jackknife: the scatter of solutions that each leave out one part. It detects a
// solution that depends on a single stroke.
ClockSquare covarianceByParts(const ClockStep& step, const ClockVector& solution) {
  const double count = static_cast<double>(step.parts.size());
  ClockVector sum = ClockVector::Zero();
  ClockSquare squares = ClockSquare::Zero();
  for (const ClockEquations& part : step.parts) {
    const ClockVector moved =
        ClockVector(
            SymmetricSolver(step.all.normal - part.normal).solve(step.all.right - part.right)) -
        solution;
    sum += moved;
    squares += moved * moved.transpose();
  }
  return (count - 1) / count * (squares - 1 / count * sum * sum.transpose());
}

struct FittedClock {
  ClockVector x = ClockVector::Zero();
  ClockSquare independent = ClockSquare::Zero(), correlated = ClockSquare::Zero(); // covariances
  double deviance = INFINITY; // deviance of the poses
  double parts = 0;           // number of half seconds
  double deviation(int k) const { return std::sqrt(std::max(independent(k, k), correlated(k, k))); }
};

class ClockSearch {
 public:
  ClockSearch(const CameraTrack& track, const std::vector<CameraPose>& poses,
              std::vector<InertialReading> windows, const ProbeModel& probe,
              const FusedOptions& options, Progress& progress)
      : track_(track), poses_(poses), windows_(std::move(windows)), probe_(probe),
        options_(options), progress_(progress), start_(windows_.front().t),
        middle_(0.5 * (start_ + windows_.back().t)) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (track.verdicts[i] != PoseVerdict::used && track.verdicts[i] != PoseVerdict::outlier)
        continue;
      first_ = std::min(first_, poses[i].t);
      last_ = std::max(last_, poses[i].t);
    }
  }

  PathFusion fusionFor(const ClockVector& x) const {
    std::vector<InertialReading> shifted = windows_;
    for (InertialReading& reading : shifted) reading.t -= x[0] + x[1] * (reading.t - middle_);
    const double margin = track_.options.longest_gap;
    std::erase_if(shifted, [&](const InertialReading& reading) {
      return reading.t < first_ - margin || reading.t > last_ + margin;
    });
    if (x[2] != 0) delayRates(shifted, x[2]);
    return PathFusion(track_, poses_, std::move(shifted), probe_, options_, progress_);
  }

  double devianceAt(double offset) const { return fusionFor(ClockVector(offset, 0, 0)).deviance(); }

  // Gauss-Newton from an offset. Returns nullopt if the motion does not determine the clock.
  std::optional<FittedClock> fitFrom(double offset) const {
    FittedClock fit{ClockVector(offset, 0, 0)};
    double last = 0; // step
    for (int round = 0; round < kRounds; ++round) {
      PathFusion fusion = fusionFor(fit.x);
      fusion.weighBothWays();
      fusion.refine();
      const ClockStep step = stepOf(fusion, fit.x);
      const SymmetricSolver solver(step.all.normal);
      if (step.count < 100 || step.parts.size() < 4 || !(solver.reciprocalCondition() > 1e-12))
        return std::nullopt;
      const ClockVector change = solver.solve(step.all.right);
      // The poses' weights follow the clock, so that the steps shrink by a ratio (Aitken 1926).
      const double ratio = round > 0 ? change[0] / last : 0;
      fit.x += change / (1 - std::clamp(ratio, 0., kMaxRatio));
      last = change[0];
      if (!(std::abs(fit.x[0]) < 1.1 * kFarthest) || !(std::abs(fit.x[1]) < 0.02))
        return std::nullopt;
      fit.independent = solver.inverse();
      fit.correlated = covarianceByParts(step, change);
      fit.parts = static_cast<double>(step.parts.size());
      if (!(std::abs(change[0]) < 0.1 * fit.deviation(0))) continue;
      fit.deviance = fusionFor(fit.x).deviance();
      return fit;
    }
    return std::nullopt;
  }

  ProbeClock clockOf(const FittedClock& fit) const {
    ProbeClock clock;
    clock.start = start_;
    clock.skew = fit.x[1];
    const double since = start_ - middle_;
    clock.offset = fit.x[0] + since * fit.x[1];
    const auto atStart = [&](const ClockSquare& P) {
      return P(0, 0) + 2 * since * P(0, 1) + since * since * P(1, 1);
    };
    clock.offset_deviation = std::sqrt(std::max(atStart(fit.independent), atStart(fit.correlated)));
    clock.skew_deviation = fit.deviation(1);
    clock.deviation = fit.deviation(0);
    // Both tests for two parameters must reject: chi squared and Hotelling's T squared.
    const auto testStatistic = [both = Vec2(fit.x.head<2>())](const ClockSquare& P) {
      return both.dot(P.topLeftCorner<2, 2>().inverse() * both);
    };
    const double free = fit.parts - 1;
    // A clock that is hardly known is corrected only if it is far off: the tests assume many parts.
    clock.is_significant =
        (clock.isKnown() || std::abs(fit.x[0]) > kFarOff * clock.deviation) &&
        testStatistic(fit.independent) > -2 * std::log(kSignificance) &&
        testStatistic(fit.correlated) > free * (std::pow(kSignificance, -2 / (free - 1)) - 1);
    return clock;
  }

  // Returns the delay of the gyroscope, whose readings are part of the windows, on this clock; 0 if
  // it is insignificant.
  double gyroscopeDelay(const ProbeClock& clock) const {
    ClockVector x = ClockVector::Zero();
    if (clock.is_significant) x.head<2>() << middle_ - clock.onCamera(middle_), clock.skew;
    double deviation = INFINITY;
    FusionScales scales;
    for (int round = 0; round < kRounds; ++round) {
      PathFusion fusion = fusionFor(x);
      fusion.setScales(scales);
      fusion.weighBothWays();
      fusion.refine();
      // The stated noise of a gyroscope says little about its errors in a quick hand.
      if (round == 0) {
        fusion.chooseVariance(&FusionScales::rate, {1, 10, 100, 1000});
        scales = fusion.scales();
        continue;
      }
      const ClockStep step = stepOf(fusion, x);
      const double change = step.all.right[2] / step.all.normal(2, 2);
      double squares = 1 / step.all.normal(2, 2); // variance
      for (const ClockEquations& part : step.parts)
        squares +=
            std::pow((part.right[2] - change * part.normal(2, 2)) / step.all.normal(2, 2), 2);
      deviation = std::sqrt(squares);
      x[2] += change;
      if (std::abs(change) < 0.1 * deviation) break;
    }
    return std::abs(x[2]) > kClearlyDelayed * deviation ? x[2] : 0;
  }

 private:
  // Moves the gyroscope's readings by a few milliseconds within their windows.
  static void delayRates(std::vector<InertialReading>& readings, double delay) {
    const std::vector<InertialReading> before = readings;
    for (std::size_t i = 1; i + 1 < readings.size(); ++i) {
      const InertialReading &a = before[i - 1], &b = before[i + 1];
      if (!readings[i].has_rate || !a.has_rate || !b.has_rate || b.t - a.t > 0.1) continue;
      readings[i].rate += delay / (b.t - a.t) * (b.rate - a.rate);
    }
  }

  ClockStep stepOf(PathFusion& fusion, const ClockVector& x) const {
    ClockStep step;
    for (const auto& [k, deviation] : {std::pair(1, kSkew), {2, kGyroscopeDelay}}) {
      step.all.normal(k, k) = 1 / (deviation * deviation);
      step.all.right[k] = -x[k] / (deviation * deviation);
    }
    double part_end = -INFINITY;
    for (const ClockInnovation& innovation : fusion.clockInnovations(middle_ - x[0])) {
      if (!std::isfinite(innovation.value) || !innovation.growth.allFinite()) continue;
      if (innovation.t > part_end) {
        step.parts.emplace_back();
        part_end = innovation.t + kCorrelationTime;
      }
      step.all.add(innovation);
      step.parts.back().add(innovation);
      step.count += 1;
    }
    return step;
  }

  const CameraTrack& track_;
  const std::vector<CameraPose>& poses_;
  std::vector<InertialReading> windows_;
  const ProbeModel& probe_;
  const FusedOptions& options_;
  Progress& progress_;
  double start_, middle_;
  double first_ = INFINITY, last_ = -INFINITY; // times of poses
};

std::string inMilliseconds(double seconds) {
  return formatNumber(std::round(1e4 * seconds) / 10) + " ms";
}

ClockFit unknownClock(const std::string& reason) {
  return {std::nullopt,
          "the probe's clock was not found beside the poses': it is taken to be theirs (" + reason +
              ")"};
}

} // namespace

ClockFit fitClock(const CameraTrack& track, const std::vector<CameraPose>& poses,
                  const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                  const FusedOptions& options, Progress& progress,
                  const std::vector<RateSample>& rates) {
  const std::vector<InertialReading> windows =
      meansOverWindows(inertialReadings(samples, {}, probe));
  if (track.empty() || windows.size() < 60) return unknownClock("the recording is too short");
  const ClockSearch search(track, poses, windows, probe, options, progress);
  std::vector<std::pair<double, double>> candidates; // deviance and offset
  for (const double offset : coarseOffsets(windows, track, probe, options.gravity)) {
    progress.throwIfCancelled();
    candidates.emplace_back(search.devianceAt(offset), offset);
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<FittedClock> fits; // at different offsets
  for (const auto& [deviance, offset] : candidates) {
    if (deviance > candidates.front().first + kHopeless) break;
    const std::optional<FittedClock> fit = search.fitFrom(offset);
    const auto isSame = [&](const FittedClock& other) {
      return std::abs(other.x[0] - fit->x[0]) < kCoarseStep;
    };
    if (fit && std::none_of(fits.begin(), fits.end(), isSame)) fits.push_back(*fit);
  }
  if (fits.empty()) return unknownClock("the motion does not determine it");
  std::sort(fits.begin(), fits.end(),
            [](const FittedClock& a, const FittedClock& b) { return a.deviance < b.deviance; });
  const FittedClock& best = fits[0];
  if (!(best.deviation(0) < kWorstOffset))
    return unknownClock("the motion shows it to " + inMilliseconds(best.deviation(0)) + " only");
  // A start that is nearly as likely would be likelier after a fit, which may fail.
  for (const auto& [deviance, offset] : candidates)
    if (std::abs(offset - best.x[0]) > 3 * kCoarseStep && deviance - best.deviance < kClearly)
      return unknownClock("offsets of " + inMilliseconds(best.x[0]) + " and " +
                          inMilliseconds(offset) + " fit alike");
  if (fits.size() > 1 && fits[1].deviance - best.deviance < kClearly)
    return unknownClock("offsets of " + inMilliseconds(best.x[0]) + " and " +
                        inMilliseconds(fits[1].x[0]) + " fit alike");
  ClockFit fit{search.clockOf(best), {}};
  // A gyroscope has a filter of its own, so that it does not share in the search.
  if (!rates.empty()) {
    const ClockSearch with_rates(track, poses,
                                 meansOverWindows(inertialReadings(samples, rates, probe)), probe,
                                 options, progress);
    fit.clock->gyroscope_delay = with_rates.gyroscopeDelay(*fit.clock);
  }
  if (!fit.clock->isKnown())
    fit.doubt =
        "the probe's clock was not found to a millisecond beside the poses': it is taken to " +
        (fit.clock->is_significant ? "be ahead by " + inMilliseconds(best.x[0]) + ", +- "
                                   : "be theirs, +- ") +
        inMilliseconds(best.deviation(0)) + "; move and turn the probe more quickly";
  return fit;
}

} // namespace patina
