#include "acquisition/filtering/path_fusion.h"

#include <algorithm>
#include <cmath>

#include "acquisition/filtering/fusion_readings.h"
#include "core/decompose.h"

namespace patina {
namespace {

constexpr std::size_t kPosesPerInterval = 6; // with one process noise
// A chi^2 of six degrees of freedom exceeds it once in 2 million.
constexpr double kOutlier = 40;

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

// Raises the deviations of a motion by its distance from the reference: where that is large, the
// linear model was wrong, and the deviations are too small.
void addLinearError(TipMotion& motion, const TipMotion& reference) {
  motion.sigma =
      std::hypot(motion.sigma, (motion.position - reference.position).norm() / std::sqrt(3.));
  motion.sigma_angle =
      std::hypot(motion.sigma_angle,
                 motion.orientation.angularDistance(reference.orientation) / std::sqrt(3.));
}

bool hasRate(const std::vector<InertialReading>& readings, const FusionEvent& event) {
  return event.reading >= 0 && readings[static_cast<std::size_t>(event.reading)].has_rate;
}

} // namespace

PathFusion::PathFusion(const CameraTrack& track, const std::vector<CameraPose>& poses,
                       std::vector<InertialReading> windows, const ProbeModel& probe,
                       const FusedOptions& options, Progress& progress)
    : track_(track), windows_(std::move(windows)), starts_(startsOf(track)),
      reference_(firstReference(track, windows_)), weights_(poses.size(), 0),
      scores_(poses.size()), input_{poses,           weights_,     probe,
                                    options.gravity, options.bias, options.rate_bias},
      progress_(progress) {
  for (std::size_t i = 0; i < poses.size(); ++i)
    weights_[i] =
        track.verdicts[i] == PoseVerdict::used || track.verdicts[i] == PoseVerdict::outlier ? 1 : 0;
  first_weights_ = weights_;
}

void PathFusion::weighBothWays() {
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

bool PathFusion::refine() {
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
        if (events[k].reference.gap) addLinearError(nodes[k], events[k].reference);
        if (events[k].pose < 0) return;
        const auto i = static_cast<std::size_t>(events[k].pose);
        scores_[i] = scoreOf(input_.poses[i], step.pose_variance, events[k], step, adjoint,
                             input_.probe.tip);
      },
      progress_);
  reference_ = ReferenceMotion(track_, std::move(times), std::move(nodes));
  return weigh();
}

void PathFusion::chooseVariance(double FusionScales::*factor,
                                std::initializer_list<double> factors) {
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

// The filter is linear, so that the sensitivity of its state to the errors runs along with it
// (separate bias: Friedland 1969).
void PathFusion::fitGyroscope() {
  constexpr double kPrior = 0.02; // deviation of a scale factor and of an axis's lean
  using Nine = Eigen::Matrix<double, 9, 1>;
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Identity() / (kPrior * kPrior);
  Nine right = Nine::Zero();
  Eigen::Matrix<double, ErrorState::kSize, 9> sensitivity;
  const std::vector<FusionEvent> events =
      fusionEvents(windows_, input_, starts_, reference_, noise_);
  FusionPass(events, windows_, input_, scales_)
      .run(
          [&](std::size_t k, const FusionStep& step) {
            if (k == events.size()) return;
            if (k == 0) sensitivity.setZero();
            if (events[k].is_segment_start)
              sensitivity.topRows<ErrorState::kBias>().setZero();
            else
              for (int column = 0; column < 9; ++column) {
                ErrorState::Vector moved = sensitivity.col(column);
                predict(moved, step.dt);
                sensitivity.col(column) = moved;
              }
            const std::ptrdiff_t reading = events[k].reading;
            const bool has_rate = hasRate(windows_, events[k]);
            for (std::size_t i = 0; i < step.count; ++i) {
              const ProcessedRow& used = step.used[i];
              Nine change = Nine::Zero(); // change of the innovation by each element
              if (has_rate && i < 3)
                change.segment<3>(3 * static_cast<int>(i)) =
                    windows_[static_cast<std::size_t>(reading)].rate;
              for (std::size_t j = 0; j < static_cast<std::size_t>(used.row.count); ++j)
                change -= used.row.value[j] * sensitivity.row(used.row.index[j]).transpose();
              sensitivity += used.gain * change.transpose();
              if (reading >= 0)
                continue; // their errors in an impact would pass for the gyroscope's
              normal += change * change.transpose() / used.variance;
              right -= used.residual / used.variance * change;
            }
          },
          nullptr, progress_);
  const Nine errors = SymmetricSolver(normal).solve(right);
  const Eigen::Matrix3d correction =
      Eigen::Matrix3d::Identity() +
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(errors.data());
  rate_correction_ = correction * rate_correction_;
  for (InertialReading& window : windows_) window.rate = correction * window.rate;
}

void PathFusion::chooseNoise() {
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

double PathFusion::deviance() {
  double sum = 0;
  for (const double each : devianceOfPoses(noise_, scales_, false)) sum += each;
  return sum;
}

// The filter is linear about its reference. Its response to displaced poses and rates is therefore
// that of the innovations to the clock (separate bias: Friedland 1969).
std::vector<ClockInnovation> PathFusion::clockInnovations(double middle) {
  constexpr double kStep = 1e-3, kSkewStep = 1e-4; // [s], relative
  const std::vector<FusionEvent> events =
      fusionEvents(windows_, input_, starts_, reference_, noise_);
  std::vector<CameraPose> poses = input_.poses;
  std::vector<InertialReading> readings = windows_;
  const FusionInput input{poses,          weights_,    input_.probe,
                          input_.gravity, input_.bias, input_.rate_bias};
  const FusionPass pass(events, readings, input, scales_);
  std::vector<ClockInnovation> innovations;
  const auto eachInnovation = [&](auto&& use) {
    std::size_t n = 0;
    pass.run(
        [&](std::size_t k, const FusionStep& step) {
          if (k == events.size()) return;
          for (std::size_t i = 0; i < step.count; ++i)
            use(n++, events[k].t, step.used[i].residual / std::sqrt(step.used[i].variance));
        },
        nullptr, progress_);
  };
  const auto differentiate = [&](int parameter, double step) {
    eachInnovation([&](std::size_t n, double, double value) {
      innovations[n].growth[parameter] = (value - innovations[n].value) / step;
    });
  };
  // The pose of time t measures the motion of the reading's time t + offset.
  const auto displacePoses = [&](auto&& delay) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (!(weights_[i] > 0)) continue;
      const CameraPose& pose = input_.poses[i];
      const TipMotion motion = reference_.at(pose.t);
      const double by = delay(pose.t);
      const Vec3 tip = pose.position + pose.orientation * input_.probe.tip;
      poses[i].orientation = pose.orientation * rotationOf(by * motion.rate);
      poses[i].position = tip + by * motion.velocity - poses[i].orientation * input_.probe.tip;
    }
  };
  eachInnovation([&](std::size_t, double t, double value) {
    innovations.push_back({t, value, Vec3::Zero()});
  });
  displacePoses([&](double) { return kStep; });
  differentiate(0, kStep);
  displacePoses([&](double t) { return kSkewStep * (t - middle); });
  differentiate(1, kSkewStep);
  if (std::none_of(readings.begin(), readings.end(),
                   [](const InertialReading& reading) { return reading.has_rate; }))
    return innovations;
  poses = input_.poses;
  for (InertialReading& reading : readings)
    reading.rate -= kStep * reference_.at(reading.t).rate_of_rate;
  differentiate(2, kStep);
  return innovations;
}

void PathFusion::writeTo(FusedPath& fused, std::vector<InertialReading> readings) {
  for (InertialReading& reading : readings) reading.rate = rate_correction_ * reading.rate;
  const std::vector<FusionEvent> events =
      fusionEvents(readings, input_, starts_, reference_, noise_);
  const FusionPass pass(events, readings, input_, scales_);
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
        const InertialReading& reading = readings[static_cast<std::size_t>(event.reading)];
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
  writeInnovations(fused, readings);
}

// Compares the streams by the stated variances: those that were chosen would hide a wrong rig.
void PathFusion::writeInnovations(FusedPath& fused, const std::vector<InertialReading>& readings) {
  const std::vector<FusionEvent> events =
      fusionEvents(readings, input_, starts_, firstReference(track_, windows_), {});
  const FusionPass pass(events, readings, input_, {});
  Innovations innovations;
  pass.run(
      [&](std::size_t k, const FusionStep& step) {
        if (k < events.size()) innovations.add(step, events[k], hasRate(readings, events[k]));
      },
      nullptr, progress_);
  innovations.writeTo(fused);
}

// Sets the weights by the scores. An outlier raises the scores of its neighbours, so that only
// the worst pose of a neighbourhood loses weight at first.
bool PathFusion::weigh() {
  constexpr std::size_t kNeighbours = 3;
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < weights_.size(); ++i)
    if (weights_[i] > 0) used.push_back(i);
  const std::vector<double> before = weights_;
  bool changed = false;
  for (std::size_t k = 0; k < used.size(); ++k) {
    const std::size_t i = used[k];
    bool is_worst = true;
    for (std::size_t j = k - std::min(k, kNeighbours);
         j < std::min(k + kNeighbours + 1, used.size()); ++j)
      is_worst = is_worst && (scores_[used[j]].nis <= scores_[i].nis || before[used[j]] < 0.3);
    const bool is_far = scores_[i].nis > kOutlier, was_rejected = before[i] < 2 * kRejected;
    const bool waits = is_far && !is_worst && before[i] >= 0.3;
    weights_[i] = waits ? 1 : is_far ? kRejected : scores_[i].weight;
    changed = changed || isOutlier(i) != was_rejected;
  }
  return changed;
}

// Returns -2 log likelihood of each used pose, given all measurements before it.
std::vector<double> PathFusion::devianceOfPoses(const std::vector<NoiseInterval>& noise,
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

} // namespace patina
