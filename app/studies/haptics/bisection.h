// Bisection of a threshold.
#pragma once

namespace patina {

// Threshold between `low`, where `holds` is true, and `high`, where it is false, to a relative
// `tolerance`.
template <class Holds>
double bisected(double low, double high, double tolerance, const Holds& holds) {
  while (high - low > tolerance * high) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace patina
