#include "acquisition/filtering/fused_path.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "acquisition/filtering/error_state.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

using State = ErrorState;

constexpr double kStandardGravity = 9.80665; // [m/s^2]
constexpr std::size_t kBlock = 256;          // events between two states that are kept
constexpr double kTurning = 0.15;            // a hand changes its motion in about this time [s]
constexpr std::size_t kUnrest = 64;          // samples over which the probe's unrest is measured

struct Event {
  TipMotion reference;
  double t = 0;
  Vec3 jerk = Vec3::Zero();            // density in the probe's frame [m^2/s^5]
  const ProbeSample* sample = nullptr; // one of the two is set
  const CameraPose* pose = nullptr;
  bool starts = false;
};

Vec3 logOf(const Eigen::Quaterniond& q) {
  const Eigen::AngleAxisd turn(q.w() < 0 ? Eigen::Quaterniond(-q.coeffs()) : q);
  return turn.angle() * turn.axis();
}

Eigen::Quaterniond expOf(const Vec3& turn) {
  const double angle = turn.norm();
  return angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle))
                   : Eigen::Quaterniond::Identity();
}

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

// How fast accelerations wander, in the probe's frame, from their differences from sample to
// sample: texture makes them restless, a hand in the air does not.
std::vector<Vec3> unrest(const std::vector<const ProbeSample*>& samples, const ProbeModel& probe) {
  Vec3 weights = Vec3::Zero();
  for (const AccelerometerAxis& axis : probe.axes) weights += axis.direction.cwiseAbs2();
  std::vector<Vec3> jerks(samples.size(), Vec3::Zero());
  for (std::size_t begin = 0; begin + 1 < samples.size(); begin += kUnrest) {
    const std::size_t end = std::min(begin + kUnrest, samples.size() - 1);
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

// A motion of which neither camera nor probe has told for longer is begun anew [s], as one that the
// camera has not seen for kUnseen.
constexpr double kUnheard = 1;

std::vector<Event> eventsOf(const std::vector<CameraPose>& poses, const CameraTrack& track,
                            const std::vector<const ProbeSample*>& samples,
                            const ProbeModel& probe) {
  const std::vector<Vec3> jerks = unrest(samples, probe);
  std::vector<Event> events;
  events.reserve(samples.size() + poses.size());
  std::size_t next = 0, node = 0;
  // Never calmer than the camera found the hand to be.
  const auto add = [&](double t, const Vec3& jerk, const ProbeSample* sample,
                       const CameraPose* pose, bool starts) {
    const TipMotion reference = motionAt(track, t);
    const double least = reference.position_noise * reference.position_noise;
    events.push_back({reference, t, jerk.cwiseMax(least), sample, pose, starts});
  };
  const auto addSample = [&](std::size_t i) {
    const bool starts = events.empty() || samples[i]->t - events.back().t > kUnheard;
    add(samples[i]->t, jerks[i], samples[i], nullptr, starts);
  };
  std::optional<double> seen; // [s], the last pose
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (track.verdicts[i] != PoseVerdict::used) continue;
    for (; next < samples.size() && samples[next]->t < poses[i].t; ++next) addSample(next);
    const bool starts = events.empty() || (node > 0 && track.fast[node].starts) ||
                        (seen && poses[i].t - *seen > kUnseen) ||
                        poses[i].t - events.back().t > kUnheard;
    seen = poses[i].t;
    add(poses[i].t,
        samples.empty() ? Vec3(Vec3::Zero()) : jerks[std::min(next, samples.size() - 1)], nullptr,
        &poses[i], starts);
    ++node;
  }
  for (; next < samples.size(); ++next) addSample(next);
  return events;
}

// One way through the events; what the way back needs is in `FusedStep`.
struct FusedStep {
  double dt = 0;
  std::array<UsedRow, 6> used;
  std::size_t count = 0;
  State::Vector x;
  Eigen::Matrix<double, State::kSize, 6> columns; // of P: tip and angle
};

class Fusion {
 public:
  Fusion(const std::vector<Event>& events, const ProbeModel& probe, const FusedOptions& options)
      : events_(events), probe_(probe), options_(options) {}

  void advance(State& state, std::size_t k, FusedStep& step) const {
    const Event& event = events_[k];
    step.count = 0;
    if (event.starts) {
      begin(state, event.reference, k == 0);
    } else {
      step.dt = event.t - events_[k - 1].t;
      const Eigen::Matrix3d R = event.reference.orientation.toRotationMatrix();
      const double turning = event.reference.angle_noise * event.reference.angle_noise;
      predict(state, step.dt, R * event.jerk.asDiagonal() * R.transpose(),
              turning * Eigen::Matrix3d::Identity());
      followReference(state, events_[k - 1].reference, event.reference, step.dt);
    }
    if (event.sample)
      useSample(state, event, step);
    else
      usePose(state, event, step);
  }

 private:
  void begin(State& state, const TipMotion& reference, bool first) const {
    if (first) {
      state = State();
      state.P.diagonal().tail<4>().setConstant(options_.bias * options_.bias);
    }
    constexpr int kMotion = State::kBias;
    state.x.head<kMotion>().setZero();
    state.P.topRows<kMotion>().setZero();
    state.P.leftCols<kMotion>().setZero();
    state.x.segment<3>(State::kTip) = reference.position;
    state.x.segment<3>(State::kVelocity) = reference.velocity;
    state.x.segment<3>(State::kAcceleration) = reference.acceleration;
    const double wide[] = {0.02, 0.3, 5, 0.1, 2, 20};
    for (int i = 0; i < 6; ++i) state.P.diagonal().segment<3>(3 * i).setConstant(wide[i] * wide[i]);
  }

  // The angle is counted from the reference, which turns otherwise than by a constant rate of rate.
  static void followReference(State& state, const TipMotion& from, const TipMotion& to, double dt) {
    const Eigen::Quaterniond expected =
        from.orientation * expOf(dt * from.rate + 0.5 * dt * dt * from.rate_of_rate);
    state.x.segment<3>(State::kAngle) -= logOf(expected.conjugate() * to.orientation);
    state.x.segment<3>(State::kRate) -= to.rate - from.rate - dt * from.rate_of_rate;
    state.x.segment<3>(State::kRateOfRate) -= to.rate_of_rate - from.rate_of_rate;
  }

  // How far the linear model may be off [m/s^2]: products of two errors of the reference. Nothing
  // beside a sensor's noise but where the camera saw nothing for long; there, biases would bear it.
  static double unmodelled(const TipMotion& reference, double arm) {
    const double angle = reference.sigma_angle, rate = angle / kTurning;
    const double acceleration = reference.sigma / (kTurning * kTurning);
    return angle * (kStandardGravity * angle + acceleration) +
           arm * rate * (rate + 2 * reference.rate.norm());
  }

  void useSample(State& state, const Event& event, FusedStep& step) const {
    const TipMotion& reference = event.reference;
    const Eigen::Matrix3d R = reference.orientation.toRotationMatrix();
    const Vec3 held = R.transpose() * (reference.acceleration - options_.gravity);
    for (std::size_t k = 0; k < probe_.axes.size(); ++k) {
      const Vec3& axis = probe_.axes[k].direction;
      const Vec3 arm = probe_.axes[k].position - probe_.tip;
      const Vec3& rate = reference.rate;
      const double constant =
          axis.dot(reference.rate_of_rate.cross(arm) + rate.cross(rate.cross(arm))) -
          (R * axis).dot(options_.gravity);
      MeasuredRow row;
      row.add(State::kAcceleration, R * axis);
      row.add(State::kAngle, axis.cross(held));
      row.add(State::kRateOfRate, arm.cross(axis));
      row.add(State::kBias + static_cast<int>(k), 1);
      const double off = unmodelled(reference, arm.norm());
      step.used[step.count++] =
          update(state, row, event.sample->acceleration[k] - constant - row.dot(state.x),
                 probe_.accelerationVariance() + off * off);
    }
  }

  void usePose(State& state, const Event& event, FusedStep& step) const {
    const CameraPose& pose = *event.pose;
    const Eigen::Quaterniond& q = event.reference.orientation;
    const Vec3 turn = logOf(q.conjugate() * pose.orientation.normalized());
    const Vec3 place = pose.position + q * probe_.tip;
    Eigen::Matrix3d cross;
    cross << 0, -probe_.tip.z(), probe_.tip.y(), probe_.tip.z(), 0, -probe_.tip.x(),
        -probe_.tip.y(), probe_.tip.x(), 0;
    const Eigen::Matrix3d lever = q.toRotationMatrix() * cross;
    for (int i = 0; i < 3; ++i) {
      MeasuredRow row;
      row.add(State::kAngle + i, 1);
      step.used[step.count++] =
          update(state, row, turn[i] - row.dot(state.x), pose.sigma_angle * pose.sigma_angle);
    }
    for (int i = 0; i < 3; ++i) {
      MeasuredRow row;
      row.add(State::kTip + i, 1);
      row.add(State::kAngle, Vec3(lever.row(i)));
      step.used[step.count++] = update(state, row, place[i] - row.dot(state.x),
                                       pose.sigma_position * pose.sigma_position);
    }
  }

  const std::vector<Event>& events_;
  const ProbeModel& probe_;
  const FusedOptions& options_;
};

class Innovations {
 public:
  void add(const FusedStep& step, bool of_pose) {
    for (std::size_t i = 0; i < step.count; ++i) {
      Mean& mean = of_pose ? poses_ : axes_[i];
      mean.sum += step.used[i].residual * step.used[i].residual / step.used[i].variance;
      mean.count += 1;
    }
  }
  void tell(FusedPath& fused) const {
    fused.pose_nis = poses_.value();
    for (std::size_t i = 0; i < axes_.size(); ++i) fused.axis_nis[i] = axes_[i].value();
  }

 private:
  struct Mean {
    double sum = 0, count = 0;
    double value() const { return count > 0 ? sum / count : 0; }
  };
  Mean poses_;
  std::array<Mean, 4> axes_;
};

PathSample sampleFrom(const Event& event, const FusedStep& step, const Adjoint& adjoint) {
  const State::Vector& x = step.x;
  const Eigen::Matrix<double, 6, 1> change = step.columns.transpose().lazyProduct(adjoint.l);
  PathSample sample;
  sample.t = event.t;
  sample.force = event.sample->force;
  sample.gap = event.reference.gap;
  sample.position = x.segment<3>(State::kTip) - change.head<3>();
  sample.orientation =
      event.reference.orientation * expOf(x.segment<3>(State::kAngle) - change.tail<3>());
  // The difference of two variances has no more digits than they have: where the camera was away
  // for long, nothing less than that is known.
  constexpr double kRounding = 1e-10;
  const auto sigmaOf = [&](int at, int column) {
    double trace = 0, least = 0;
    for (int i = 0; i < 3; ++i) {
      const auto known = step.columns.col(column + i);
      const State::Vector learnt = adjoint.L.lazyProduct(known);
      trace += known[at + i] - known.dot(learnt);
      least += kRounding * known[at + i];
    }
    return std::sqrt(std::max({trace, least, 0.}) / 3);
  };
  sample.sigma = sigmaOf(State::kTip, 0);
  sample.sigma_angle = sigmaOf(State::kAngle, 3);
  return sample;
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
                   const FusedOptions& options, Progress& progress) {
  FusedPath fused;
  fused.track = std::move(track);
  if (fused.track.empty()) return fused;
  const std::vector<Event> events = eventsOf(poses, fused.track, usable(samples), probe);
  const Fusion fusion(events, probe, options);
  std::vector<State> kept;
  State state;
  std::vector<FusedStep> steps(kBlock);
  Innovations innovations;
  for (std::size_t k = 0; k < events.size(); ++k) {
    if (k % kBlock == 0) {
      progress.throwIfCancelled();
      progress.report(0.4 * static_cast<double>(k) / static_cast<double>(events.size()), "filter");
      kept.push_back(state);
    }
    fusion.advance(state, k, steps[0]);
    if (!events[k].starts) innovations.add(steps[0], events[k].pose != nullptr);
  }
  innovations.tell(fused);
  for (std::size_t i = 0; i < 4; ++i) fused.bias[i] = state.x[State::kBias + static_cast<int>(i)];
  fused.path.reserve(samples.size());
  Adjoint adjoint;
  for (std::size_t block = kept.size(); block-- > 0;) {
    progress.throwIfCancelled();
    progress.report(1 - 0.6 * static_cast<double>(block) / static_cast<double>(kept.size()),
                    "smoother");
    const std::size_t begin = block * kBlock, end = std::min(begin + kBlock, events.size());
    state = kept[block];
    for (std::size_t k = begin; k < end; ++k) {
      FusedStep& step = steps[k - begin];
      fusion.advance(state, k, step);
      step.x = state.x;
      step.columns << state.P.middleCols<3>(State::kTip), state.P.middleCols<3>(State::kAngle);
    }
    for (std::size_t k = end; k-- > begin;) {
      const FusedStep& step = steps[k - begin];
      if (events[k].sample) fused.path.push_back(sampleFrom(events[k], step, adjoint));
      for (std::size_t i = step.count; i-- > 0;) adjoint.backThrough(step.used[i]);
      if (events[k].starts)
        adjoint.forget();
      else
        adjoint.backThroughStep(step.dt);
    }
  }
  std::reverse(fused.path.begin(), fused.path.end());
  for (const PathSample& sample : fused.path)
    if (!sample.position.allFinite() || !(sample.sigma >= 0) || !std::isfinite(sample.sigma))
      throw Error("the filter knows nothing at " + formatNumber(sample.t) +
                  " s: poses and probe are too far apart in time or place");
  return fused;
}

FusedPath fusePath(const std::vector<CameraPose>& poses, const std::vector<ProbeSample>& samples,
                   const ProbeModel& probe, const FusedOptions& options) {
  Progress progress;
  return fuseWith(firstPass(poses, probe, options), poses, samples, probe, options, progress);
}

} // namespace patina
