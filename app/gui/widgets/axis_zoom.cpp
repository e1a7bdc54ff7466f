#include "app/gui/widgets/axis_zoom.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {
constexpr double kNotch = 1.25;
} // namespace

AxisSpan zoomed(const AxisSpan& whole, const AxisSpan& seen, double at, double notches,
                double least) {
  const double most = whole.length();
  const double length =
      std::clamp(seen.length() * std::pow(kNotch, -notches), std::min(least, most), most);
  const double part = (at - seen.from) / seen.length();
  return shifted(whole, {at - part * length, at + (1 - part) * length}, 0);
}

AxisSpan shifted(const AxisSpan& whole, const AxisSpan& seen, double by) {
  const double length = std::min(seen.length(), whole.length());
  const double from = std::clamp(seen.from + by, whole.from, whole.to - length);
  return {from, from + length};
}

} // namespace patina
