// Error state of the fused path: prediction, scalar measurement updates, and the modified
// Bryson-Frazier smoother, which needs no inverse (Bierman 1973).
#pragma once

#include <array>

#include "core/types.h"

namespace patina {

// Tip, velocity and acceleration in the path's frame; angle from the reference, angular rate and
// acceleration in the probe's frame; biases of the accelerometers and of the gyroscope, whose rows
// and columns are zero if the probe has none.
struct ErrorState {
  static constexpr int kTip = 0, kVelocity = 3, kAcceleration = 6;
  static constexpr int kAngle = 9, kRate = 12, kRateOfRate = 15, kBias = 18, kRateBias = 22,
                       kSize = 25;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Square = Eigen::Matrix<double, kSize, kSize>;
  Vector x = Vector::Zero();
  Square P = Square::Zero();
};

// Sparse row h of the measurement matrix, for one scalar measurement.
struct MeasurementRow {
  int count = 0;
  std::array<int, 13> index{};
  std::array<double, 13> value{};

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

// A processed measurement, as the backward pass needs it.
struct ProcessedRow {
  MeasurementRow row;
  ErrorState::Vector gain;
  double residual = 0, variance = 0; // S
};

// Predicts the state; `jerk` [m^2/s^5] and `angular_jerk` [rad^2/s^5] are noise densities.
void predict(ErrorState& state, double dt, const Eigen::Matrix3d& jerk,
             const Eigen::Matrix3d& angular_jerk);

// Predicts the mean alone.
void predict(ErrorState::Vector& x, double dt);

// Updates the state; `residual` is the measurement minus its prediction.
ProcessedRow update(ErrorState& state, const MeasurementRow& row, double residual, double variance);

// Backward variables of the smoother: smoothed x = x - P l, smoothed P = P - P L P.
struct BrysonFrazierState {
  ErrorState::Vector l = ErrorState::Vector::Zero();
  ErrorState::Square L = ErrorState::Square::Zero();

  void smoothMeasurement(const ProcessedRow& used);
  void smoothStep(double dt);
  void reset(); // resets all but the biases, at a restart of the motion
};

} // namespace patina
