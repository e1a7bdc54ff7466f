// Where something stops to hold.
#pragma once

namespace patina {

// Between `low`, where it holds, and `high`, where it does not, to `tolerance` of it.
template <class Holds>
double bisected(double low, double high, double tolerance, const Holds& holds) {
  while (high - low > tolerance * high) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace patina
