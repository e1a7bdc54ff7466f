#include "acquisition/profile/rough_process.h"

#include <cmath>

namespace patina {
namespace {

constexpr double kDrive = 6.4; // density that makes the rms 1

// exp(F u) e^u, F the companion of (1 + d/du)^4: the series ends.
RoughSquare transition(double u) {
  RoughSquare N = RoughSquare::Identity();
  N(0, 1) = N(1, 2) = N(2, 3) = 1;
  N.row(3) += Eigen::RowVector4d(-1, -4, -6, -4);
  const RoughSquare N2 = N * N;
  return std::exp(-u) * (RoughSquare::Identity() + u * N + u * u / 2 * N2 + u * u * u / 6 * N2 * N);
}

} // namespace

RoughSquare roughCovariance() {
  RoughSquare P;
  P << 1, 0, -0.2, 0, 0, 0.2, 0, -0.2, -0.2, 0, 0.2, 0, 0, -0.2, 0, 1;
  return P;
}

RoughStep roughStep(double distance) {
  RoughStep step;
  step.A = transition(distance);
  if (distance > 0.3) {
    const RoughSquare P = roughCovariance();
    step.Q = P - step.A * P * step.A.transpose();
    return step;
  }
  // The same as an integral: the difference would be lost in rounding. Gauss' rule of 6 points.
  constexpr double kAt[] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
  constexpr double kWeight[] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
  step.Q.setZero();
  for (int i = 0; i < 3; ++i)
    for (const double side : {-1., 1.}) {
      const RoughState column = transition(distance / 2 * (1 + side * kAt[i])).col(3);
      step.Q += kDrive * kWeight[i] * distance / 2 * column * column.transpose();
    }
  return step;
}

RoughStep roughTurn(double cosine) {
  RoughStep turn;
  turn.A = RoughState(1, cosine, cosine * cosine, cosine * cosine * cosine).asDiagonal();
  const RoughSquare P = roughCovariance();
  turn.Q = P - turn.A * P * turn.A.transpose();
  return turn;
}

} // namespace patina
