#include "acquisition/filtering/motion_filter.h"

#include <cmath>

namespace patina {

SteadyGains steadyGains(double index) {
  // r = (4 + index - sqrt(8 index + index^2)) / 4 without the difference of near equals.
  const double root = std::sqrt(index * (8 + index));
  const double lost = 2 * index / (root + index); // 1 - r, as (root - index) / 4
  const double alpha = lost * (2 - lost);
  const double beta = 2 * lost * lost;
  return {alpha, beta};
}

} // namespace patina
