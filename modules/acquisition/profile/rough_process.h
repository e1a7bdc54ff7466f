// Roughness along a path as a random process in arc length, so that Kalman's filter can carry it:
// Matern of order 7/2, whose spectrum is level at long wavelengths and falls with the eighth power.
#pragma once

#include <Eigen/Core>

namespace patina {

// Height and its first three derivatives by arc length, each in powers of the wave number: all [m].
using RoughState = Eigen::Matrix<double, 4, 1>;
using RoughSquare = Eigen::Matrix<double, 4, 4>;

struct RoughStep {
  RoughSquare A, Q; // Q for roughness of rms 1
};

// Of rms 1, whatever the wave number.
RoughSquare roughCovariance();

// Over `distance` times wave number, not negative.
RoughStep roughStep(double distance);

// Where a path turns: the cosine between old and new direction. -1 is the way back, on which odd
// derivatives change their sign; 0 knows of the height alone.
RoughStep roughTurn(double cosine);

} // namespace patina
