#include "acquisition/filtering/fusion_pass.h"

#include <algorithm>
#include <cmath>

#include "core/decompose.h"
#include "core/progress.h"

namespace patina {
namespace {

using State = ErrorState;
using Six = Eigen::Matrix<double, 6, 1>;
using SixSquare = Eigen::Matrix<double, 6, 6>;

constexpr double kStandardGravity = 9.80665; // [m/s^2]
constexpr std::size_t kBlock = 128;          // events between two stored states
constexpr double kTurning = 0.15;            // time scale of a hand's changes of motion [s]
constexpr double kMaxProbeGap = 1; // gap in both streams after which the motion restarts [s]
constexpr double kSoftGate = 22.5; // a chi^2 of six degrees of freedom exceeds it once in 1000
constexpr double kExactDeviance = -4000; // cost of a pose without variances
// Cost of a pose as an outlier: 3 % of poses are, somewhere within 75 deviations.
constexpr double kOutlierDeviance = 33;
constexpr double kUsual = 10.6; // nine of ten squared residuals are less and keep their weight
constexpr double kStudent = 4;  // degrees of freedom of a pose's error

Eigen::Matrix3d crossMatrix(const Vec3& v) {
  Eigen::Matrix3d cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return cross;
}

// Corrects the angle's origin for the reference's changing angular acceleration.
void followReference(State& state, const TipMotion& from, const TipMotion& to, double dt) {
  const Eigen::Quaterniond expected =
      from.orientation * rotationOf(dt * from.rate + 0.5 * dt * dt * from.rate_of_rate);
  state.x.segment<3>(State::kAngle) -= rotationVector(expected.conjugate() * to.orientation);
  state.x.segment<3>(State::kRate) -= to.rate - from.rate - dt * from.rate_of_rate;
  state.x.segment<3>(State::kRateOfRate) -= to.rate_of_rate - from.rate_of_rate;
}

// Returns the error of the linear model [m/s^2], of second order in the reference's errors. It is
// negligible except in long gaps of the camera, where it would otherwise bias the biases.
double unmodelled(const TipMotion& reference, double arm) {
  const double angle = reference.sigma_angle, rate = angle / kTurning;
  const double acceleration = reference.sigma / (kTurning * kTurning);
  return angle * (kStandardGravity * angle + acceleration) +
         arm * rate * (rate + 2 * reference.rate.norm());
}

// Returns the deviation of three axes from `column`, of smoothed covariance P - P L P.
double smoothedSigma(const State& state, int column, const BrysonFrazierState& adjoint) {
  // Cancellation in the difference of two variances limits sigma in long gaps of the camera.
  constexpr double kRounding = 1e-10;
  double trace = 0, least = 0;
  for (int i = column; i < column + 3; ++i) {
    const auto known = state.P.col(i);
    const State::Vector learnt = adjoint.L.lazyProduct(known);
    trace += known[i] - known.dot(learnt);
    least += kRounding * known[i];
  }
  return std::sqrt(std::max({trace, least, 0.}) / 3);
}

} // namespace

Vec3 rotationVector(const Eigen::Quaterniond& q) {
  const Eigen::AngleAxisd turn(q.w() < 0 ? Eigen::Quaterniond(-q.coeffs()) : q);
  return turn.angle() * turn.axis();
}

Eigen::Quaterniond rotationOf(const Vec3& turn) {
  const double angle = turn.norm();
  return angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle))
                   : Eigen::Quaterniond::Identity();
}

TipMotion ReferenceMotion::at(double t) const {
  TipMotion motion = motionAt(*track_, t);
  if (nodes_.size() < 2 || t < times_.front() || t > times_.back()) return motion;
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
  const auto k = static_cast<std::size_t>(after - times_.begin());
  const TipMotion &a = nodes_[k - 1], &b = nodes_[k];
  const double h = times_[k] - times_[k - 1];
  constexpr double kMaxStep = 0.1; // [s]
  if (!(h > 0) || h > kMaxStep) return motion;
  const double s = (t - times_[k - 1]) / h, s2 = s * s, s3 = s2 * s;
  // Cubic Hermite polynomials of position and rotation vector.
  const double h10 = s3 - 2 * s2 + s, h01 = 3 * s2 - 2 * s3, h11 = s3 - s2;
  const Vec3 turn = rotationVector(a.orientation.conjugate() * b.orientation);
  const Vec3 end_rate = b.rate + 0.5 * turn.cross(b.rate);
  motion.orientation =
      a.orientation * rotationOf(h * h10 * a.rate + h01 * turn + h * h11 * end_rate);
  motion.position =
      a.position + h01 * (b.position - a.position) + h * h10 * a.velocity + h * h11 * b.velocity;
  motion.velocity = a.velocity + s * (b.velocity - a.velocity);
  motion.acceleration = a.acceleration + s * (b.acceleration - a.acceleration);
  motion.rate = a.rate + s * (b.rate - a.rate);
  motion.rate_of_rate = a.rate_of_rate + s * (b.rate_of_rate - a.rate_of_rate);
  motion.sigma = a.sigma + s * (b.sigma - a.sigma);
  motion.sigma_angle = a.sigma_angle + s * (b.sigma_angle - a.sigma_angle);
  return motion;
}

std::vector<FusionEvent> fusionEvents(const std::vector<InertialReading>& readings,
                                      const FusionInput& input, const std::vector<double>& starts,
                                      const ReferenceMotion& reference,
                                      const std::vector<NoiseInterval>& noise) {
  std::vector<FusionEvent> events;
  events.reserve(readings.size() + input.poses.size());
  std::size_t next = 0, start = 0;
  const auto addReading = [&] {
    const double t = readings[next].t;
    const bool is_segment_start = events.empty() || t - events.back().t > kMaxProbeGap;
    events.push_back(
        {reference.at(t), t, static_cast<std::ptrdiff_t>(next++), -1, is_segment_start});
  };
  std::optional<double> seen; // time of the last pose [s]
  for (std::size_t i = 0; i < input.poses.size(); ++i) {
    if (!(input.weights[i] > 0)) continue;
    const double t = input.poses[i].t;
    while (next < readings.size() && readings[next].t < t) addReading();
    while (start < starts.size() && starts[start] < t) ++start;
    const bool is_segment_start =
        events.empty() || (seen && start < starts.size() && starts[start] == t) ||
        (seen && t - *seen > kMaxGap) || t - events.back().t > kMaxProbeGap;
    seen = t;
    events.push_back({reference.at(t), t, -1, static_cast<std::ptrdiff_t>(i), is_segment_start});
  }
  while (next < readings.size()) addReading();
  // The camera does not show in a gap how abruptly the hand moves: at least as elsewhere on
  // average.
  double squares = 0, count = 0;
  for (const FusionEvent& event : events) {
    if (event.reference.gap) continue;
    squares += event.reference.angle_noise * event.reference.angle_noise;
    count += 1;
  }
  const double usual = count > 0 ? std::sqrt(squares / count) : 0;
  for (FusionEvent& event : events)
    if (event.reference.gap)
      event.reference.angle_noise = std::max(event.reference.angle_noise, usual);
  std::size_t interval = 0;
  for (FusionEvent& event : events) {
    while (interval + 1 < noise.size() && event.t > noise[interval].until) ++interval;
    if (noise.empty()) break;
    event.angle_scale = noise[interval].angle;
    event.jerk_scale = noise[interval].jerk;
  }
  return events;
}

PoseRows poseRows(const CameraPose& pose, const TipMotion& reference, const Vec3& tip) {
  PoseRows rows;
  const Eigen::Quaterniond& q = reference.orientation;
  rows.measured << rotationVector(q.conjugate() * pose.orientation.normalized()),
      pose.position + q * tip;
  const Eigen::Matrix3d lever = q.toRotationMatrix() * crossMatrix(tip);
  for (int i = 0; i < 3; ++i) {
    rows.row[static_cast<std::size_t>(i)].add(State::kAngle + i, 1);
    MeasurementRow& place = rows.row[static_cast<std::size_t>(i + 3)];
    place.add(State::kTip + i, 1);
    place.add(State::kAngle, Vec3(lever.row(i)));
  }
  rows.variance.head<3>().setConstant(pose.sigma_angle * pose.sigma_angle);
  rows.variance.tail<3>().setConstant(pose.sigma_position * pose.sigma_position);
  return rows;
}

void FusionPass::begin(State& state, const TipMotion& reference, bool first) const {
  if (first) {
    state = State();
    state.P.diagonal().segment<4>(State::kBias).setConstant(input_.bias * input_.bias);
    state.P.diagonal()
        .segment<3>(State::kRateBias)
        .setConstant(input_.rate_bias * input_.rate_bias);
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

void FusionPass::advance(State& state, std::size_t k, FusionStep& step) const {
  const FusionEvent& event = events_[k];
  step.count = 0;
  step.pose_variance = 1;
  if (event.is_segment_start) {
    begin(state, event.reference, k == 0);
  } else {
    const TipMotion& reference = event.reference;
    step.dt = event.t - events_[k - 1].t;
    const auto at = static_cast<std::ptrdiff_t>(k);
    const std::ptrdiff_t near = event.reading >= 0                        ? event.reading
                                : at + 1 < std::ptrdiff_t(events_.size()) ? events_[k + 1].reading
                                                                          : events_[k - 1].reading;
    const double least = reference.position_noise * reference.position_noise;
    const Vec3 jerk = event.jerk_scale *
                      (near >= 0 ? readings_[static_cast<std::size_t>(near)].jerk : Vec3(0, 0, 0))
                          .cwiseMax(least);
    const Eigen::Matrix3d R = reference.orientation.toRotationMatrix();
    const double turning = event.angle_scale * reference.angle_noise * reference.angle_noise;
    predict(state, step.dt, R * jerk.asDiagonal() * R.transpose(),
            turning * Eigen::Matrix3d::Identity());
    followReference(state, events_[k - 1].reference, reference, step.dt);
    if (event.reading >= 0)
      state.P.diagonal().segment<3>(State::kVelocity).array() +=
          readings_[static_cast<std::size_t>(event.reading)].velocity_variance;
  }
  if (event.reading >= 0)
    useReading(state, k, step);
  else
    usePose(state, k, step);
}

void FusionPass::useReading(State& state, std::size_t k, FusionStep& step) const {
  const TipMotion& reference = events_[k].reference;
  const InertialReading& reading = readings_[static_cast<std::size_t>(events_[k].reading)];
  const Vec3& rate = reference.rate;
  // The rate of the angle's error is exact: the probe's rate is the reference's, turned by the
  // angle, plus kRate.
  if (reading.has_rate) {
    const Eigen::Matrix3d turned = crossMatrix(rate);
    for (int i = 0; i < 3; ++i) {
      MeasurementRow row;
      row.add(State::kRate + i, 1);
      row.add(State::kAngle, Vec3(turned.row(i)));
      row.add(State::kRateBias + i, 1);
      step.used[step.count++] = update(state, row, reading.rate[i] - rate[i] - row.dot(state.x),
                                       scales_.rate * reading.rate_variance);
    }
  }
  if (!reading.has_acceleration) return;
  const Eigen::Matrix3d R = reference.orientation.toRotationMatrix();
  const Vec3 held = R.transpose() * (reference.acceleration - input_.gravity);
  for (std::size_t i = 0; i < input_.probe.axes.size(); ++i) {
    const Vec3& axis = input_.probe.axes[i].direction;
    const Vec3 arm = input_.probe.axes[i].position - input_.probe.tip;
    const double constant =
        axis.dot(reference.rate_of_rate.cross(arm) + rate.cross(rate.cross(arm))) -
        (R * axis).dot(input_.gravity);
    const Vec3 of_turning = arm.cross(axis);
    const Vec3 of_rate = rate.cross(arm).cross(axis) + arm.cross(axis.cross(rate));
    MeasurementRow row;
    row.add(State::kAcceleration, R * axis);
    row.add(State::kAngle,
            axis.cross(held) + of_turning.cross(reference.rate_of_rate) + of_rate.cross(rate));
    row.add(State::kRate, of_rate + of_turning.cross(rate));
    row.add(State::kRateOfRate, of_turning);
    row.add(State::kBias + static_cast<int>(i), 1);
    const double off = unmodelled(reference, arm.norm());
    step.used[step.count++] =
        update(state, row, reading.acceleration[i] - constant - row.dot(state.x),
               scales_.acceleration * reading.acceleration_variance + off * off);
  }
}

void FusionPass::usePose(State& state, std::size_t k, FusionStep& step) const {
  const auto i = static_cast<std::size_t>(events_[k].pose);
  const PoseRows rows = poseRows(input_.poses[i], events_[k].reference, input_.probe.tip);
  step.pose_variance = 1 / input_.weights[i];
  if (soft_) {
    SixSquare known;
    Six residual;
    for (std::size_t a = 0; a < 6; ++a) {
      const State::Vector column = rows.row[a].columns(state.P);
      residual[int(a)] = rows.measured[int(a)] - rows.row[a].dot(state.x);
      for (std::size_t b = 0; b < 6; ++b) known(int(a), int(b)) = rows.row[b].dot(column);
    }
    for (int round = 0; round < 20; ++round) {
      const SixSquare S = known + SixSquare((step.pose_variance * rows.variance).asDiagonal());
      const SymmetricSolver solver(S);
      const double nis = residual.dot(solver.solve(residual));
      if (round == 0)
        step.pose_deviance =
            (solver.reciprocalCondition() > 0 ? solver.logDeterminant() : kExactDeviance) +
            std::min(nis, kOutlierDeviance);
      if (!(nis > 1.01 * kSoftGate) || !(rows.variance.minCoeff() > 0)) break;
      step.pose_variance *= nis / kSoftGate;
    }
  }
  for (std::size_t a = 0; a < 6; ++a)
    step.used[step.count++] =
        update(state, rows.row[a], rows.measured[int(a)] - rows.row[a].dot(state.x),
               step.pose_variance * rows.variance[int(a)]);
}

void FusionPass::run(const Visit& visit, const Smoothed& smoothed, Progress& progress) const {
  std::vector<State> kept;
  State state;
  std::vector<FusionStep> steps(smoothed ? kBlock : 1);
  for (std::size_t k = 0; k < events_.size(); ++k) {
    if (k % kBlock == 0) {
      progress.throwIfCancelled();
      if (smoothed) kept.push_back(state);
    }
    advance(state, k, steps[0]);
    if (visit) visit(k, steps[0]);
  }
  if (visit && !events_.empty()) {
    steps[0].state = state;
    visit(events_.size(), steps[0]);
  }
  BrysonFrazierState adjoint;
  for (std::size_t block = kept.size(); block-- > 0;) {
    progress.throwIfCancelled();
    const std::size_t begin = block * kBlock, end = std::min(begin + kBlock, events_.size());
    state = kept[block];
    for (std::size_t k = begin; k < end; ++k) {
      FusionStep& step = steps[k - begin];
      advance(state, k, step);
      step.state = state;
    }
    for (std::size_t k = end; k-- > begin;) {
      const FusionStep& step = steps[k - begin];
      smoothed(k, step, adjoint);
      for (std::size_t i = step.count; i-- > 0;) adjoint.smoothMeasurement(step.used[i]);
      if (events_[k].is_segment_start)
        adjoint.reset();
      else
        adjoint.smoothStep(step.dt);
    }
  }
}

TipMotion smoothedMotion(const FusionEvent& event, const FusionStep& step,
                         const BrysonFrazierState& adjoint) {
  const State::Vector x = step.state.x - step.state.P.lazyProduct(adjoint.l);
  const Vec3 angle = x.segment<3>(State::kAngle);
  const TipMotion& reference = event.reference;
  TipMotion motion = reference; // with its noise and gap
  motion.position = x.segment<3>(State::kTip);
  motion.velocity = x.segment<3>(State::kVelocity);
  motion.acceleration = x.segment<3>(State::kAcceleration);
  motion.orientation = (reference.orientation * rotationOf(angle)).normalized();
  const Vec3 rate = x.segment<3>(State::kRate);
  motion.rate = reference.rate + reference.rate.cross(angle) + rate;
  motion.rate_of_rate = reference.rate_of_rate + reference.rate_of_rate.cross(angle) +
                        reference.rate.cross(rate) + x.segment<3>(State::kRateOfRate);
  motion.sigma = smoothedSigma(step.state, State::kTip, adjoint);
  motion.sigma_angle = smoothedSigma(step.state, State::kAngle, adjoint);
  return motion;
}

PoseScore scoreOf(const CameraPose& pose, double variance_factor, const FusionEvent& event,
                  const FusionStep& step, const BrysonFrazierState& adjoint, const Vec3& tip) {
  const PoseRows rows = poseRows(pose, event.reference, tip);
  if (!(rows.variance.minCoeff() > 0)) return {};
  const State::Vector x = step.state.x - step.state.P.lazyProduct(adjoint.l);
  Eigen::Matrix<double, State::kSize, 6> columns, learnt;
  Six residual;
  for (std::size_t a = 0; a < 6; ++a) {
    columns.col(int(a)) = rows.row[a].columns(step.state.P);
    learnt.col(int(a)) = adjoint.L.lazyProduct(columns.col(int(a)));
    residual[int(a)] = rows.measured[int(a)] - rows.row[a].dot(x);
  }
  SixSquare known = -columns.transpose().lazyProduct(learnt);
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b)
      known(int(a), int(b)) += rows.row[a].dot(columns.col(int(b)));
  const Six scale = rows.variance.cwiseSqrt().cwiseInverse();
  const SixSquare relative = scale.asDiagonal() * known * scale.asDiagonal();
  const Six whitened = scale.cwiseProduct(residual);
  PoseScore score;
  // Takes the pose out of the smoothed state, along the axes of its information.
  const SixSquare even = 0.5 / variance_factor * (relative + relative.transpose());
  const SymmetricEigen axes(even);
  const Six along = axes.vectors.transpose() * whitened;
  for (int i = 0; i < 6; ++i) {
    const double share = std::clamp(axes.values[i], 0., 0.999);
    const double variance = variance_factor * share / (1 - share) + 1;
    score.nis += std::pow(along[i] / (1 - share), 2) / variance;
    score.volume += std::log(variance);
  }
  // The pose's own residual would hide a pose beside a gap, which draws the path to itself.
  score.weight = std::min((kStudent + kUsual) / (kStudent + score.nis), 1.);
  return score;
}

} // namespace patina
