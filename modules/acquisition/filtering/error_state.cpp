#include "acquisition/filtering/error_state.h"

#include <limits>

namespace patina {
namespace {

using State = ErrorState;

// Computes P F^T by columns.
void stepColumns(State::Square& P, double dt) {
  const double half = 0.5 * dt * dt;
  for (const int at : {State::kTip, State::kAngle}) {
    P.middleCols<3>(at) += dt * P.middleCols<3>(at + 3) + half * P.middleCols<3>(at + 6);
    P.middleCols<3>(at + 3) += dt * P.middleCols<3>(at + 6);
  }
}

// Computes F P, one column at a time.
void stepRows(State::Square& P, double dt) {
  const double half = 0.5 * dt * dt;
  for (double* column = P.data(); column != P.data() + P.size(); column += State::kSize)
    for (const int at : {State::kTip, State::kAngle})
      for (int i = at; i < at + 3; ++i) {
        column[i] += dt * column[i + 3] + half * column[i + 6];
        column[i + 3] += dt * column[i + 6];
      }
}

// Computes P F and F^T P, for the backward pass.
void stepRowsBack(State::Square& P, double dt) {
  const double half = 0.5 * dt * dt;
  for (double* column = P.data(); column != P.data() + P.size(); column += State::kSize)
    for (const int at : {State::kTip, State::kAngle})
      for (int i = at; i < at + 3; ++i) {
        column[i + 6] += dt * column[i + 3] + half * column[i];
        column[i + 3] += dt * column[i];
      }
}
void stepColumnsBack(State::Square& P, double dt) {
  const double half = 0.5 * dt * dt;
  for (const int at : {State::kTip, State::kAngle}) {
    P.middleCols<3>(at + 6) += dt * P.middleCols<3>(at + 3) + half * P.middleCols<3>(at);
    P.middleCols<3>(at + 3) += dt * P.middleCols<3>(at);
  }
}

// Symmetrises the covariance. Rounding errors would otherwise accumulate in its antisymmetric part.
void symmetrize(State::Square& P) {
  for (int i = 0; i < State::kSize; ++i)
    for (int k = 0; k < i; ++k) P(i, k) = P(k, i) = 0.5 * (P(i, k) + P(k, i));
}

void addNoise(State::Square& P, int at, double dt, const Eigen::Matrix3d& density) {
  const double d2 = dt * dt, d3 = d2 * dt;
  const double parts[3][3] = {
      {d2 * d3 / 20, d2 * d2 / 8, d3 / 6}, {d2 * d2 / 8, d3 / 3, d2 / 2}, {d3 / 6, d2 / 2, dt}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) P.block<3, 3>(at + 3 * i, at + 3 * j) += parts[i][j] * density;
}

} // namespace

State::Vector MeasurementRow::columns(const State::Square& P) const {
  State::Vector sum = value[0] * P.col(index[0]);
  for (std::size_t i = 1; i < static_cast<std::size_t>(count); ++i)
    sum += value[i] * P.col(index[i]);
  return sum;
}

double MeasurementRow::dot(const State::Vector& x) const {
  double sum = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) sum += value[i] * x[index[i]];
  return sum;
}

void predict(State::Vector& x, double dt) {
  for (const int at : {State::kTip, State::kAngle}) {
    x.segment<3>(at) += dt * x.segment<3>(at + 3) + 0.5 * dt * dt * x.segment<3>(at + 6);
    x.segment<3>(at + 3) += dt * x.segment<3>(at + 6);
  }
}

void predict(State& state, double dt, const Eigen::Matrix3d& jerk,
             const Eigen::Matrix3d& angular_jerk) {
  predict(state.x, dt);
  stepColumns(state.P, dt);
  stepRows(state.P, dt);
  addNoise(state.P, State::kTip, dt, jerk);
  addNoise(state.P, State::kAngle, dt, angular_jerk);
  symmetrize(state.P);
}

ProcessedRow update(State& state, const MeasurementRow& row, double residual, double variance) {
  ProcessedRow used;
  used.row = row;
  const State::Vector Ph = row.columns(state.P);
  used.residual = residual;
  used.variance = row.dot(Ph) + variance;
  if (!(used.variance > 0)) { // both state and measurement are exact
    used.gain.setZero();
    used.residual = 0;
    used.variance = std::numeric_limits<double>::infinity();
    return used;
  }
  used.gain = Ph / used.variance;
  state.x += used.gain * residual;
  // P - K S K^T, which is symmetric to the last bits; predict() takes care of these.
  for (int i = 0; i < State::kSize; ++i) state.P.col(i) -= Ph[i] * used.gain;
  return used;
}

void BrysonFrazierState::smoothMeasurement(const ProcessedRow& used) {
  // (I - K h)^T L (I - K h) + h h^T / S changes only rows and columns of h.
  const State::Vector LK = L.lazyProduct(used.gain);
  const double KLK = used.gain.dot(LK), lK = l.dot(used.gain);
  const MeasurementRow& row = used.row;
  const auto count = static_cast<std::size_t>(row.count);
  for (std::size_t i = 0; i < count; ++i) {
    L.col(row.index[i]) -= row.value[i] * LK;
    l[row.index[i]] -= row.value[i] * (lK + used.residual / used.variance);
  }
  for (std::size_t i = 0; i < count; ++i) L.row(row.index[i]) -= row.value[i] * LK.transpose();
  const double both = KLK + 1 / used.variance;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j)
      L(row.index[i], row.index[j]) += both * row.value[i] * row.value[j];
}

void BrysonFrazierState::smoothStep(double dt) {
  for (const int at : {State::kTip, State::kAngle}) {
    l.segment<3>(at + 6) += dt * l.segment<3>(at + 3) + 0.5 * dt * dt * l.segment<3>(at);
    l.segment<3>(at + 3) += dt * l.segment<3>(at);
  }
  stepColumnsBack(L, dt);
  stepRowsBack(L, dt);
  symmetrize(L);
}

void BrysonFrazierState::reset() {
  l.head<State::kBias>().setZero();
  L.topRows<State::kBias>().setZero();
  L.leftCols<State::kBias>().setZero();
}

} // namespace patina
