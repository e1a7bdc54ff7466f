#include "acquisition/filtering/fused_path.h"

#include <algorithm>
#include <cmath>

#include "acquisition/filtering/fusion_pass.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kWindow = 8e-3;         // readings that the coarse passes take together [s]
constexpr std::size_t kNoiseWindow = 64; // samples over which the probe's process noise is measured
constexpr std::size_t kPosesPerInterval = 6; // with one process noise
constexpr double kLeastNoise = 0.01;         // no accelerometer has less [m/s^2]
constexpr double kOutlier = 40;    // a chi^2 of six degrees of freedom exceeds it once in 2 million
constexpr double kRejected = 1e-4; // weight of an outlier, which the next pass may take back

std::vector<const ProbeSample*> usable(const std::vector<ProbeSample>& samples) {
  std::vector<const ProbeSample*> kept;
  for (const ProbeSample& sample : samples) {
    const bool finite = std::isfinite(sample.t) && std::isfinite(sample.force) &&
                        std::all_of(sample.acceleration.begin(), sample.acceleration.end(),
                                    [](double a) { return std::isfinite(a); });
    if (finite && (kept.empty() || sample.t > kept.back()->t)) kept.push_back(&sample);
  }
  return kept;
}

// Returns the process noise of the acceleration in the probe's frame, from differences of
// successive samples. Texture raises it, motion in the air hardly does.
std::vector<Vec3> processNoise(const std::vector<const ProbeSample*>& samples,
                               const ProbeModel& probe) {
  Vec3 weights = Vec3::Zero();
  for (const AccelerometerAxis& axis : probe.axes) weights += axis.direction.cwiseAbs2();
  std::vector<Vec3> jerks(samples.size(), Vec3::Zero());
  for (std::size_t begin = 0; begin + 1 < samples.size(); begin += kNoiseWindow) {
    const std::size_t end = std::min(begin + kNoiseWindow, samples.size() - 1);
    Vec3 jerk = Vec3::Zero();
    for (std::size_t k = 0; k < probe.axes.size(); ++k) {
      double squares = 0, seconds = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const double change = samples[i + 1]->acceleration[k] - samples[i]->acceleration[k];
        squares += change * change - 2 * probe.accelerationVariance();
        seconds += samples[i + 1]->t - samples[i]->t;
      }
      jerk += std::max(squares / seconds, 0.) * probe.axes[k].direction.cwiseAbs2();
    }
    jerk = jerk.cwiseQuotient(weights.cwiseMax(1e-3));
    std::fill(jerks.begin() + static_cast<std::ptrdiff_t>(begin),
              jerks.begin() + static_cast<std::ptrdiff_t>(end + 1), jerk);
  }
  return jerks;
}

// Merges both streams; readings at one time are one.
std::vector<InertialReading> readingsOf(const std::vector<const ProbeSample*>& samples,
                                        const std::vector<RateSample>& rates,
                                        const ProbeModel& probe) {
  const std::vector<Vec3> jerks = processNoise(samples, probe);
  std::vector<InertialReading> readings;
  readings.reserve(std::max(samples.size(), rates.size()));
  std::size_t next = 0;
  const auto addRate = [&](const RateSample& rate) {
    if (!std::isfinite(rate.t) || !rate.rate.allFinite()) return;
    if (readings.empty() || readings.back().t != rate.t) {
      if (!readings.empty() && rate.t < readings.back().t) return;
      readings.emplace_back();
      readings.back().t = rate.t;
      readings.back().jerk =
          jerks.empty() ? Vec3(0, 0, 0) : jerks[std::min(readings.size() - 1, jerks.size() - 1)];
    }
    InertialReading& reading = readings.back();
    reading.rate = rate.rate;
    reading.rate_variance = probe.rate_noise * probe.rate_noise;
    reading.has_rate = true;
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const ProbeSample& sample = *samples[i];
    while (next < rates.size() && rates[next].t < sample.t) addRate(rates[next++]);
    InertialReading reading;
    reading.t = sample.t;
    reading.acceleration = sample.acceleration;
    reading.acceleration_variance =
        std::max(probe.accelerationVariance(), kLeastNoise * kLeastNoise);
    reading.jerk = jerks[i];
    reading.force = sample.force;
    reading.has_acceleration = reading.is_sample = true;
    readings.push_back(reading);
    while (next < rates.size() && !(rates[next].t > sample.t)) addRate(rates[next++]);
  }
  while (next < rates.size()) addRate(rates[next++]);
  return readings;
}

// Returns means of readings over windows. The filter is linear about its reference, and a hand
// moves little within a window, so that coarse passes lose almost nothing (the idea of
// preintegration: Forster, Carlone, Dellaert & Scaramuzza 2017).
std::vector<InertialReading> windowsOf(const std::vector<InertialReading>& readings) {
  std::vector<InertialReading> windows;
  for (std::size_t begin = 0; begin < readings.size();) {
    std::size_t end = begin;
    InertialReading mean;
    double count = 0, accelerations = 0, rates = 0;
    for (; end < readings.size() && readings[end].t - readings[begin].t < kWindow; ++end) {
      const InertialReading& reading = readings[end];
      mean.t += reading.t - readings[begin].t;
      mean.jerk += reading.jerk;
      count += 1;
      if (reading.has_acceleration) {
        for (std::size_t i = 0; i < 4; ++i) mean.acceleration[i] += reading.acceleration[i];
        mean.acceleration_variance += reading.acceleration_variance;
        accelerations += 1;
      }
      if (reading.has_rate) {
        mean.rate += reading.rate;
        mean.rate_variance += reading.rate_variance;
        rates += 1;
      }
    }
    mean.t = readings[begin].t + mean.t / count;
    mean.jerk /= count;
    mean.has_acceleration = accelerations > 0;
    mean.has_rate = rates > 0;
    if (accelerations > 0) {
      for (double& value : mean.acceleration) value /= accelerations;
      mean.acceleration_variance /= accelerations * accelerations;
      // The mean of a random walk differs from its value at the middle.
      mean.acceleration_variance +=
          mean.jerk.mean() * (readings[end - 1].t - readings[begin].t) / 12;
    }
    if (rates > 0) {
      mean.rate /= rates;
      mean.rate_variance /= rates * rates;
    }
    windows.push_back(mean);
    begin = end;
  }
  return windows;
}

std::vector<double> startsOf(const CameraTrack& track) {
  std::vector<double> starts;
  for (std::size_t k = 1; k < track.fast.size(); ++k)
    if (track.fast[k].is_segment_start) starts.push_back(track.fast[k].t);
  for (std::size_t k = 1; k < track.slow.size(); ++k)
    if (track.slow[k].is_segment_start) starts.push_back(track.slow[k].t);
  return starts;
}

class Innovations {
 public:
  void add(const FusionStep& step, const FusionEvent& event, bool has_rate) {
    for (std::size_t i = 0; i < step.count; ++i) {
      const double nis = step.used[i].residual * step.used[i].residual / step.used[i].variance;
      if (!std::isfinite(nis)) continue;
      if (!event.is_segment_start) of(i, event, has_rate).add(nis);
    }
  }
  void writeTo(FusedPath& fused) const {
    fused.pose_nis = poses_.value();
    for (std::size_t i = 0; i < axes_.size(); ++i) fused.axis_nis[i] = axes_[i].value();
  }

 private:
  struct Mean {
    double sum = 0, count = 0;
    void add(double value) { sum += value, count += 1; }
    double value() const { return count > 0 ? sum / count : 0; }
  };
  Mean& of(std::size_t i, const FusionEvent& event, bool has_rate) {
    if (event.pose >= 0) return poses_;
    if (!has_rate) return axes_[i];
    return i < 3 ? rates_ : axes_[i - 3];
  }
  Mean poses_, rates_;
  std::array<Mean, 4> axes_;
};

// Returns the same events with time reversed, in which velocities and rates change their signs.
std::vector<FusionEvent> reversed(const std::vector<FusionEvent>& events) {
  std::vector<FusionEvent> backwards(events.rbegin(), events.rend());
  for (std::size_t k = 0; k < backwards.size(); ++k) {
    FusionEvent& event = backwards[k];
    event.t = -event.t;
    event.reference.velocity *= -1;
    event.reference.rate *= -1;
    // A segment starts in reverse where the next one starts.
    event.is_segment_start = k == 0 || events[events.size() - k].is_segment_start;
  }
  return backwards;
}

// Returns the camera's motion at the windows, turned by the gyroscope where the camera has gaps.
ReferenceMotion firstReference(const CameraTrack& track,
                               const std::vector<InertialReading>& windows) {
  std::vector<double> times;
  std::vector<TipMotion> nodes;
  for (const InertialReading& window : windows) {
    if (!window.has_rate) continue;
    times.push_back(window.t);
    nodes.push_back(motionAt(track, window.t));
  }
  std::vector<Vec3> rates;
  for (const InertialReading& window : windows)
    if (window.has_rate) rates.push_back(window.rate);
  constexpr double kDrift = 0.02; // deviation of the turned orientation [rad]
  for (std::size_t begin = 1; begin < nodes.size(); ++begin) {
    if (!nodes[begin].gap) continue;
    std::size_t end = begin; // first node after the gap
    while (end < nodes.size() && nodes[end].gap) ++end;
    std::vector<Eigen::Quaterniond> turned{nodes[begin - 1].orientation};
    for (std::size_t k = begin; k <= end && k < nodes.size(); ++k) {
      const Vec3 turn = 0.5 * (times[k] - times[k - 1]) * (rates[k - 1] + rates[k]);
      turned.push_back(turned.back() * rotationOf(turn));
    }
    const Vec3 missed = end < nodes.size()
                            ? rotationVector(turned.back().conjugate() * nodes[end].orientation)
                            : Vec3(0, 0, 0);
    for (std::size_t k = begin; k < end; ++k) {
      const double share =
          end < nodes.size() ? (times[k] - times[begin - 1]) / (times[end] - times[begin - 1]) : 0;
      nodes[k].orientation = turned[k - begin + 1] * rotationOf(share * missed);
      nodes[k].rate = rates[k];
      nodes[k].rate_of_rate.setZero();
      nodes[k].sigma_angle = std::min(nodes[k].sigma_angle, kDrift);
    }
    begin = end;
  }
  return ReferenceMotion(track, std::move(times), std::move(nodes));
}

// A fusion's working state: the weights of the poses and the reference get better in each pass.
class Fusion {
 public:
  Fusion(const CameraTrack& track, const std::vector<CameraPose>& poses,
         const std::vector<InertialReading>& readings, const ProbeModel& probe,
         const FusedOptions& options, Progress& progress)
      : track_(track), readings_(readings), windows_(windowsOf(readings)), starts_(startsOf(track)),
        reference_(firstReference(track, windows_)), weights_(poses.size(), 0),
        scores_(poses.size()), input_{poses,           weights_,     probe,
                                      options.gravity, options.bias, options.rate_bias},
        progress_(progress) {
    for (std::size_t i = 0; i < poses.size(); ++i)
      weights_[i] =
          track.verdicts[i] == PoseVerdict::used || track.verdicts[i] == PoseVerdict::outlier ? 1
                                                                                              : 0;
    first_weights_ = weights_;
  }

  // Weighs each pose by its innovation in the better one of both directions of time, since a pose
  // beside a gap cannot be tested from one side.
  void weighBothWays() {
    weights_ = first_weights_;
    std::vector<FusionEvent> events = fusionEvents(windows_, input_, starts_, reference_, noise_);
    std::vector<double> least(weights_.size(), INFINITY);
    std::vector<InertialReading> readings = windows_;
    for (const bool back : {false, true}) {
      if (back) {
        events = reversed(events);
        for (InertialReading& reading : readings) reading.rate *= -1;
      }
      FusionPass pass(events, readings, input_, scales_);
      pass.softenPoses();
      pass.run(
          [&](std::size_t k, const FusionStep& step) {
            if (k == events.size() || events[k].pose < 0) return;
            double& variance = least[static_cast<std::size_t>(events[k].pose)];
            variance = std::min(variance, step.pose_variance);
          },
          nullptr, progress_);
    }
    for (std::size_t i = 0; i < weights_.size(); ++i)
      if (weights_[i] > 0) weights_[i] = 1 / least[i];
  }

  // Smooths the means over windows, weighs the poses and linearises about the result.
  void refine() {
    const std::vector<FusionEvent> events =
        fusionEvents(windows_, input_, starts_, reference_, noise_);
    const FusionPass pass(events, windows_, input_, scales_);
    std::vector<double> times(events.size());
    std::vector<TipMotion> nodes(events.size());
    pass.run(
        nullptr,
        [&](std::size_t k, const FusionStep& step, const BrysonFrazierState& adjoint) {
          times[k] = events[k].t;
          nodes[k] = smoothedMotion(events[k], step, adjoint);
          if (events[k].pose < 0) return;
          const auto i = static_cast<std::size_t>(events[k].pose);
          scores_[i] = scoreOf(input_.poses[i], step.pose_variance, events[k], step, adjoint,
                               input_.probe.tip);
        },
        progress_);
    weigh();
    reference_ = ReferenceMotion(track_, std::move(times), std::move(nodes));
  }

  void forgetWeights() { weights_ = first_weights_; }

  // Chooses the factor of a sensor's variance by the likelihood of the poses.
  void chooseVariance(double FusionScales::*factor, std::initializer_list<double> factors) {
    double least = INFINITY;
    FusionScales best = scales_;
    for (const double value : factors) {
      FusionScales trial = scales_;
      trial.*factor = value;
      const std::vector<double> deviances = devianceOfPoses(noise_, trial, false);
      double sum = 0;
      for (const double deviance : deviances) sum += deviance;
      if (!(sum < least)) break;
      least = sum;
      best = trial;
    }
    scales_ = best;
  }

  // Chooses the process noise of each few poses by their likelihood: a hand that rests needs less
  // than one that taps. An interval gets the largest noise of its neighbours, too.
  void chooseNoise() {
    constexpr double kPreference = 2; // gain in deviance that a larger noise needs
    const NoiseInterval kinds[] = {{0, 1, 1}, {0, 8, 3}, {0, 64, 8}};
    std::vector<std::vector<double>> deviances;
    for (const NoiseInterval& kind : kinds)
      deviances.push_back(devianceOfPoses({kind}, scales_, true));
    const std::vector<double>& first = deviances[0];
    const std::size_t count = (first.size() + kPosesPerInterval - 1) / kPosesPerInterval;
    std::vector<std::size_t> best(count, 0);
    for (std::size_t b = 0; b < count; ++b) {
      const std::size_t begin = b * kPosesPerInterval,
                        end = std::min(begin + kPosesPerInterval, first.size());
      double least = INFINITY;
      for (std::size_t kind = 0; kind < deviances.size(); ++kind) {
        double sum = kPreference * static_cast<double>(kind);
        for (std::size_t i = begin; i < end; ++i) sum += deviances[kind][i];
        if (!(sum < least)) continue;
        least = sum;
        best[b] = kind;
      }
    }
    noise_.clear();
    std::size_t used = 0, interval = 0;
    const auto add = [&](double until) {
      const std::size_t from = interval - std::min<std::size_t>(interval, 1),
                        to = std::min(interval + 2, count);
      NoiseInterval kind = kinds[*std::max_element(best.begin() + std::ptrdiff_t(from),
                                                   best.begin() + std::ptrdiff_t(to))];
      kind.until = until;
      noise_.push_back(kind);
      ++interval;
    };
    double last = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      if (!(weights_[i] > 0)) continue;
      last = input_.poses[i].t;
      if (++used % kPosesPerInterval == 0) add(last);
    }
    if (interval < count) add(last);
  }

  const std::vector<PoseScore>& scores() const { return scores_; }

  void writeTo(FusedPath& fused) {
    const std::vector<FusionEvent> events =
        fusionEvents(readings_, input_, starts_, reference_, noise_);
    const FusionPass pass(events, readings_, input_, scales_);
    pass.run(
        [&](std::size_t k, const FusionStep& step) {
          if (k < events.size()) return;
          const ErrorState& last = step.state;
          for (std::size_t i = 0; i < 4; ++i)
            fused.bias[i] = last.x[ErrorState::kBias + static_cast<int>(i)];
          fused.rate_bias = last.x.segment<3>(ErrorState::kRateBias);
        },
        [&](std::size_t k, const FusionStep& step, const BrysonFrazierState& adjoint) {
          const FusionEvent& event = events[k];
          if (event.reading < 0) return;
          const InertialReading& reading = readings_[static_cast<std::size_t>(event.reading)];
          if (!reading.is_sample) return;
          const TipMotion motion = smoothedMotion(event, step, adjoint);
          PathSample sample;
          sample.t = event.t;
          sample.force = reading.force;
          sample.position = motion.position;
          sample.orientation = motion.orientation;
          sample.sigma = motion.sigma;
          sample.sigma_angle = motion.sigma_angle;
          fused.path.push_back(sample);
        },
        progress_);
    std::reverse(fused.path.begin(), fused.path.end());
    writeInnovations(fused);
  }

 private:
  // Compares the streams by the stated variances: those that were chosen would hide a wrong rig.
  void writeInnovations(FusedPath& fused) {
    const std::vector<FusionEvent> events =
        fusionEvents(readings_, input_, starts_, firstReference(track_, windows_), {});
    const FusionPass pass(events, readings_, input_, {});
    Innovations innovations;
    pass.run(
        [&](std::size_t k, const FusionStep& step) {
          if (k < events.size()) innovations.add(step, events[k], hasRate(readings_, events[k]));
        },
        nullptr, progress_);
    innovations.writeTo(fused);
  }

  // Sets the weights by the scores. An outlier raises the scores of its neighbours, so that only
  // the worst pose of a neighbourhood loses weight at first.
  void weigh() {
    constexpr std::size_t kNeighbours = 3;
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < weights_.size(); ++i)
      if (weights_[i] > 0) used.push_back(i);
    const std::vector<double> before = weights_;
    for (std::size_t k = 0; k < used.size(); ++k) {
      const std::size_t i = used[k];
      bool is_worst = true;
      for (std::size_t j = k - std::min(k, kNeighbours);
           j < std::min(k + kNeighbours + 1, used.size()); ++j)
        is_worst = is_worst && (scores_[used[j]].nis <= scores_[i].nis || before[used[j]] < 0.3);
      const bool waits = scores_[i].nis > kOutlier && !is_worst && before[i] >= 0.3;
      weights_[i] = waits ? 1 : scores_[i].nis > kOutlier ? kRejected : scores_[i].weight;
    }
  }

  // Returns -2 log likelihood of each used pose, given all measurements before it.
  std::vector<double> devianceOfPoses(const std::vector<NoiseInterval>& noise,
                                      const FusionScales& scales, bool cross) {
    const std::vector<FusionEvent> events =
        fusionEvents(windows_, input_, starts_, reference_, noise);
    FusionPass pass(events, windows_, input_, scales);
    pass.softenPoses();
    std::vector<double> deviances;
    if (cross) {
      pass.run(
          nullptr,
          [&](std::size_t k, const FusionStep& step, const BrysonFrazierState& adjoint) {
            if (events[k].pose < 0) return;
            const PoseScore score =
                scoreOf(input_.poses[std::size_t(events[k].pose)], step.pose_variance, events[k],
                        step, adjoint, input_.probe.tip);
            deviances.push_back(score.volume + std::min(score.nis, 33.));
          },
          progress_);
      std::reverse(deviances.begin(), deviances.end());
      return deviances;
    }
    pass.run(
        [&](std::size_t k, const FusionStep& step) {
          if (k == events.size() || events[k].pose < 0) return;
          deviances.push_back(step.pose_deviance);
        },
        nullptr, progress_);
    return deviances;
  }

  static bool hasRate(const std::vector<InertialReading>& readings, const FusionEvent& event) {
    return event.reading >= 0 && readings[static_cast<std::size_t>(event.reading)].has_rate;
  }

  const CameraTrack& track_;
  const std::vector<InertialReading>& readings_;
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
  const std::vector<InertialReading> readings = readingsOf(usable(samples), rates, probe);
  Fusion fusion(fused.track, poses, readings, probe, options, progress);
  progress.report(0.1, "filter");
  fusion.weighBothWays();
  fusion.refine();
  fusion.forgetWeights();
  if (!rates.empty()) fusion.chooseVariance(&FusionScales::rate, {1, 10, 100, 1000});
  fusion.chooseVariance(&FusionScales::acceleration, {1, 4, 16, 64, 256});
  fusion.chooseNoise();
  fusion.weighBothWays();
  fusion.refine();
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (fused.track.verdicts[i] == PoseVerdict::used ||
        fused.track.verdicts[i] == PoseVerdict::outlier)
      fused.track.verdicts[i] =
          fusion.scores()[i].nis > kOutlier ? PoseVerdict::outlier : PoseVerdict::used;
  progress.report(0.4, "smoother");
  fused.path.reserve(samples.size());
  fusion.writeTo(fused);
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
