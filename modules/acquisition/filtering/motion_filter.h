// Kalman filter and RTS smoother (Rauch, Tung & Striebel 1965) for constant velocity or
// acceleration (A06). Several channels (axes) of equal measurement noise share one covariance.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace patina {

// Model of the noise in the highest derivative (DWNA and CWNA, Bar-Shalom et al. 2001).
enum class ProcessNoise {
  piecewise_constant, // constant in each step: Q = sigma^2 G G^T, as in the paper. [m/s^2], [m/s^3]
  continuous_white    // density sigma^2; steps may be subdivided. [m/s^1.5], [m/s^2.5]
};

// N = 2: position and velocity; N = 3: also acceleration.
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
    if (noise == ProcessNoise::piecewise_constant)
      step.Q << d2 * d2 / 4, d3 / 2, d3 / 2, d2;
    else
      step.Q << d3 / 3, d2 / 2, d2 / 2, dt;
  } else {
    step.F(0, 2) = d2 / 2;
    step.F(1, 2) = dt;
    if (noise == ProcessNoise::piecewise_constant) {
      const Eigen::Vector3d G(d3 / 6, d2 / 2, dt);
      step.Q = G * G.transpose();
    } else {
      step.Q << d3 * d2 / 20, d2 * d2 / 8, d3 / 6, d2 * d2 / 8, d3 / 3, d2 / 2, d3 / 6, d2 / 2, dt;
    }
  }
  step.Q *= sigma * sigma;
  return step;
}

// Returns the symmetrised covariance, with rows and columns of negative variances set to zero.
template <int N>
Eigen::Matrix<double, N, N> symmetrized(const Eigen::Matrix<double, N, N>& covariance) {
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

// Returns a state from a position; the velocity has deviation `speed` and changes in `seconds`.
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
  state.P = symmetrized<N>(step.F * state.P * step.F.transpose() + step.Q);
}

// Innovation of a measured position.
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

// Updates in Joseph form, which stays symmetric and positive under rounding, and returns the gain.
// A variance of 0 is an exact measurement; it changes nothing if the state is exact, too.
template <int N, int C>
Eigen::Matrix<double, N, 1> update(MotionState<N, C>& state, const Innovation<C>& innovation) {
  const double R = innovation.variance - state.P(0, 0);
  Eigen::Matrix<double, N, 1> K = Eigen::Matrix<double, N, 1>::Zero();
  if (innovation.variance > 0) K = state.P.col(0) / innovation.variance;
  state.x += K * innovation.residual;
  Eigen::Matrix<double, N, N> rest = Eigen::Matrix<double, N, N>::Identity();
  rest.col(0) -= K;
  state.P = symmetrized<N>(rest * state.P * rest.transpose() + (R > 0 ? R : 0) * K * K.transpose());
  return K;
}

// Returns the gain of one backward step of the RTS smoother, from the covariances before and after
// it. It is zero if the step was certain.
template <int N>
Eigen::Matrix<double, N, N> smootherGain(const Eigen::Matrix<double, N, N>& filtered,
                                         const Eigen::Matrix<double, N, N>& predicted,
                                         const MotionStep<N>& step) {
  using Square = Eigen::Matrix<double, N, N>;
  const Eigen::Matrix<double, N, 1> scale =
      predicted.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Square equilibrated = scale.asDiagonal() * predicted * scale.asDiagonal();
  Square inverse;
  bool invertible = false;
  equilibrated.computeInverseWithCheck(inverse, invertible, 1e-13);
  if (!invertible) return Square::Zero();
  return filtered * step.F.transpose() * (scale.asDiagonal() * inverse * scale.asDiagonal());
}

// Returns the smoothed state before a step, given the predicted and smoothed ones after it.
template <int N, int C>
MotionState<N, C> smoothed(const MotionState<N, C>& filtered, const MotionState<N, C>& predicted,
                           const MotionState<N, C>& next, const Eigen::Matrix<double, N, N>& gain) {
  MotionState<N, C> state;
  state.x = filtered.x + gain * (next.x - predicted.x);
  state.P = symmetrized<N>(filtered.P + gain * (next.P - predicted.P) * gain.transpose());
  return state;
}

// Interpolates between two smoothed states, `first` + `second` seconds apart, with continuous white
// noise; `gain` is that of the step. It gives the state of a smoother with a node there.
template <int N, int C>
MotionState<N, C> between(const MotionState<N, C>& before, const MotionState<N, C>& after,
                          const Eigen::Matrix<double, N, N>& gain, double first, double second,
                          double sigma) {
  using Square = Eigen::Matrix<double, N, N>;
  const MotionStep<N> to = motionStep<N>(first, sigma, ProcessNoise::continuous_white);
  const MotionStep<N> from = motionStep<N>(second, sigma, ProcessNoise::continuous_white);
  const MotionStep<N> whole = motionStep<N>(first + second, sigma, ProcessNoise::continuous_white);
  if (!(sigma > 0) || !(first > 0) || !(second > 0)) {
    MotionState<N, C> state = before;
    predict(state, to);
    return first > 0 && !(second > 0) ? after : state;
  }
  const Eigen::Matrix<double, N, 1> scale = whole.Q.diagonal().cwiseSqrt().cwiseInverse();
  const Square equilibrated = scale.asDiagonal() * whole.Q * scale.asDiagonal();
  const Square B = to.Q * from.F.transpose() *
                   (scale.asDiagonal() * equilibrated.inverse() * scale.asDiagonal());
  const Square A = to.F - B * whole.F;
  MotionState<N, C> state;
  state.x = A * before.x + B * after.x;
  const Square mixed = A * gain * after.P * B.transpose();
  state.P = symmetrized<N>(A * before.P * A.transpose() + B * after.P * B.transpose() + mixed +
                           mixed.transpose() + to.Q - B * from.F * to.Q);
  return state;
}

} // namespace patina
