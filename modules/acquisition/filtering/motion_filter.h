// Kalman filter and RTS smoother of motion with constant velocity or acceleration (A06), for
// several channels (axes) that share one covariance because they are measured alike.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace patina {

// What disturbs the highest derivative that is kept.
enum class ProcessNoise {
  held, // a new value each step, held over it: Q = sigma^2 G G^T, the paper's. [m/s^2], [m/s^3]
  white // of density sigma^2: a step may be split without a change. [m/s^1.5], [m/s^2.5]
};

// N = 2: position and velocity; N = 3: and acceleration.
template <int N> struct MotionStep {
  using Square = Eigen::Matrix<double, N, N>;
  Square F, Q;
};

template <int N> MotionStep<N> motionStep(double dt, double sigma, ProcessNoise noise) {
  static_assert(N == 2 || N == 3);
  MotionStep<N> step;
  step.F.setIdentity();
  step.F(0, 1) = dt;
  const double d2 = dt * dt, d3 = d2 * dt;
  if constexpr (N == 2) {
    if (noise == ProcessNoise::held)
      step.Q << d2 * d2 / 4, d3 / 2, d3 / 2, d2;
    else
      step.Q << d3 / 3, d2 / 2, d2 / 2, dt;
  } else {
    step.F(0, 2) = d2 / 2;
    step.F(1, 2) = dt;
    if (noise == ProcessNoise::held) {
      const Eigen::Vector3d G(d3 / 6, d2 / 2, dt);
      step.Q = G * G.transpose();
    } else {
      step.Q << d3 * d2 / 20, d2 * d2 / 8, d3 / 6, d2 * d2 / 8, d3 / 3, d2 / 2, d3 / 6, d2 / 2, dt;
    }
  }
  step.Q *= sigma * sigma;
  return step;
}

// What rounding may have taken from a covariance: symmetry, and where something is known exactly
// the sign of a variance, which then is zero and has nothing in common with anything.
template <int N>
Eigen::Matrix<double, N, N> settled(const Eigen::Matrix<double, N, N>& covariance) {
  Eigen::Matrix<double, N, N> P = 0.5 * (covariance + covariance.transpose());
  for (int i = 0; i < N; ++i)
    if (!(P(i, i) > 0)) {
      P.row(i).setZero();
      P.col(i).setZero();
    }
  return P;
}

// Rows are derivatives, columns are channels.
template <int N, int C> struct MotionState {
  Eigen::Matrix<double, N, C> x = Eigen::Matrix<double, N, C>::Zero();
  Eigen::Matrix<double, N, N> P = Eigen::Matrix<double, N, N>::Zero();
};

// A state that knows its place by one measurement, and that it moves no faster than `speed` [m/s]
// and changes that within `seconds` or more.
template <int N, int C>
MotionState<N, C> firstState(const Eigen::Matrix<double, 1, C>& measured, double variance,
                             double speed, double seconds = 0.1) {
  MotionState<N, C> state;
  state.x.row(0) = measured;
  state.P(0, 0) = variance;
  state.P(1, 1) = speed * speed;
  if constexpr (N == 3) state.P(2, 2) = speed * speed / (seconds * seconds);
  return state;
}

template <int N, int C> void predict(MotionState<N, C>& state, const MotionStep<N>& step) {
  state.x = step.F * state.x;
  state.P = settled<N>(step.F * state.P * step.F.transpose() + step.Q);
}

// What a measured position says before it is used.
template <int C> struct Innovation {
  Eigen::Matrix<double, 1, C> residual;
  double variance;                                                 // S, of each channel
  double nis() const { return residual.squaredNorm() / variance; } // chi^2 of C degrees of freedom
};

template <int N, int C>
Innovation<C> innovationOf(const MotionState<N, C>& state,
                           const Eigen::Matrix<double, 1, C>& measured, double variance) {
  return {measured - state.x.row(0), state.P(0, 0) + variance};
}

// Joseph form: symmetric and positive whatever rounding does (P - K H P is not). Returns the gain.
// A variance of 0 is an exact measurement; where nothing is uncertain it changes nothing.
template <int N, int C>
Eigen::Matrix<double, N, 1> update(MotionState<N, C>& state, const Innovation<C>& innovation) {
  const double R = innovation.variance - state.P(0, 0);
  Eigen::Matrix<double, N, 1> K = Eigen::Matrix<double, N, 1>::Zero();
  if (innovation.variance > 0) K = state.P.col(0) / innovation.variance;
  state.x += K * innovation.residual;
  Eigen::Matrix<double, N, N> rest = Eigen::Matrix<double, N, N>::Identity();
  rest.col(0) -= K;
  state.P = settled<N>(rest * state.P * rest.transpose() + (R > 0 ? R : 0) * K * K.transpose());
  return K;
}

// The gain of one step back of Rauch, Tung and Striebel, from the covariances before and after it.
// Zero where the step was certain: there is nothing to learn from later.
template <int N>
Eigen::Matrix<double, N, N> smootherGain(const Eigen::Matrix<double, N, N>& filtered,
                                         const Eigen::Matrix<double, N, N>& predicted,
                                         const MotionStep<N>& step) {
  using Square = Eigen::Matrix<double, N, N>;
  const Eigen::Matrix<double, N, 1> scale =
      predicted.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Square even = scale.asDiagonal() * predicted * scale.asDiagonal();
  Square inverse;
  bool invertible = false;
  even.computeInverseWithCheck(inverse, invertible, 1e-13);
  if (!invertible) return Square::Zero();
  return filtered * step.F.transpose() * (scale.asDiagonal() * inverse * scale.asDiagonal());
}

// `filtered` before a step, `predicted` after it, `next` smoothed there; becomes smoothed.
template <int N, int C>
MotionState<N, C> smoothed(const MotionState<N, C>& filtered, const MotionState<N, C>& predicted,
                           const MotionState<N, C>& next, const Eigen::Matrix<double, N, N>& gain) {
  MotionState<N, C> state;
  state.x = filtered.x + gain * (next.x - predicted.x);
  state.P = settled<N>(filtered.P + gain * (next.P - predicted.P) * gain.transpose());
  return state;
}

// Between two smoothed states, `first` + `second` seconds apart, whose step back had this gain;
// white noise. What a smoother would have said there had it stopped there.
template <int N, int C>
MotionState<N, C> between(const MotionState<N, C>& before, const MotionState<N, C>& after,
                          const Eigen::Matrix<double, N, N>& gain, double first, double second,
                          double sigma) {
  using Square = Eigen::Matrix<double, N, N>;
  const MotionStep<N> to = motionStep<N>(first, sigma, ProcessNoise::white);
  const MotionStep<N> from = motionStep<N>(second, sigma, ProcessNoise::white);
  const MotionStep<N> whole = motionStep<N>(first + second, sigma, ProcessNoise::white);
  if (!(sigma > 0) || !(first > 0) || !(second > 0)) {
    MotionState<N, C> state = before;
    predict(state, to);
    return first > 0 && !(second > 0) ? after : state;
  }
  const Eigen::Matrix<double, N, 1> scale = whole.Q.diagonal().cwiseSqrt().cwiseInverse();
  const Square even = scale.asDiagonal() * whole.Q * scale.asDiagonal();
  const Square B =
      to.Q * from.F.transpose() * (scale.asDiagonal() * even.inverse() * scale.asDiagonal());
  const Square A = to.F - B * whole.F;
  MotionState<N, C> state;
  state.x = A * before.x + B * after.x;
  const Square mixed = A * gain * after.P * B.transpose();
  state.P = settled<N>(A * before.P * A.transpose() + B * after.P * B.transpose() + mixed +
                       mixed.transpose() + to.Q - B * from.F * to.Q);
  return state;
}

// The gains to which a filter of constant velocity with held noise settles (T-A06a), in closed
// form: alpha of the position, beta / dt of the velocity. `index` is sigma dt^2 / sigma_measured.
struct SteadyGains {
  double alpha, beta;
};
SteadyGains steadyGains(double index);

} // namespace patina
