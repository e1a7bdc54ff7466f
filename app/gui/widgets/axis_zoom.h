// What of an axis is seen: the whole, or a part that the wheel and a drag choose.
#pragma once

namespace patina {

struct AxisSpan {
  double from = 0, to = 1;
  double length() const { return to - from; }
  bool operator==(const AxisSpan&) const = default;
};

// `notches` of the wheel nearer (> 0) or farther, so that `at` stays where it is; at least `least`
// long, and never more than the whole.
AxisSpan zoomed(const AxisSpan& whole, const AxisSpan& seen, double at, double notches,
                double least);
// As long as before, within the whole.
AxisSpan shifted(const AxisSpan& whole, const AxisSpan& seen, double by);

} // namespace patina
