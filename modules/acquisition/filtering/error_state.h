// The state of the fused path and its exact bookkeeping: prediction, scalar measurements in Joseph
// form, and the smoother's way back without an inverse (Bierman 1973).
#pragma once

#include <array>

#include "core/types.h"

namespace patina {

// Tip, its velocity and acceleration in the path's frame; angle from the reference, its rate and
// rate of rate in the probe's; biases of the accelerometers.
struct ErrorState {
  static constexpr int kTip = 0, kVelocity = 3, kAcceleration = 6;
  static constexpr int kAngle = 9, kRate = 12, kRateOfRate = 15, kBias = 18, kSize = 22;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Square = Eigen::Matrix<double, kSize, kSize>;
  Vector x = Vector::Zero();
  Square P = Square::Zero();
};

// Of one number that is measured: its few coefficients.
struct MeasuredRow {
  int count = 0;
  std::array<int, 10> index{};
  std::array<double, 10> value{};

  void add(int at, double coefficient) {
    if (coefficient == 0) return;
    index[static_cast<std::size_t>(count)] = at;
    value[static_cast<std::size_t>(count++)] = coefficient;
  }
  void add(int at, const Vec3& coefficients) {
    for (int i = 0; i < 3; ++i) add(at + i, coefficients[i]);
  }
  ErrorState::Vector columns(const ErrorState::Square& P) const; // P h
  double dot(const ErrorState::Vector& x) const;
};

// What the way back needs of one measurement.
struct UsedRow {
  MeasuredRow row;
  ErrorState::Vector gain;
  double residual = 0, variance = 0; // S
};

// `jerk` and `angular_jerk` are densities of white noise [m^2/s^5], [rad^2/s^5].
void predict(ErrorState& state, double dt, const Eigen::Matrix3d& jerk,
             const Eigen::Matrix3d& angular_jerk);

// `residual` = measured - expected of the state as it is.
UsedRow update(ErrorState& state, const MeasuredRow& row, double residual, double variance);

// What later measurements say of a state: smoothed x = x - P l, P = P - P L P.
struct Adjoint {
  ErrorState::Vector l = ErrorState::Vector::Zero();
  ErrorState::Square L = ErrorState::Square::Zero();

  void backThrough(const UsedRow& used);
  void backThroughStep(double dt);
  void forget(); // all but the biases: before this the motion was another one
};

} // namespace patina
