#include "app/studies/haptics/swing_limit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/studies/haptics/bisection.h"

namespace patina {
namespace {

constexpr double kPi = std::numbers::pi;

bool dies(SampledLoop loop, const WornGear& gear, double stiffness,
          const std::function<double(double)>& speed) {
  // The swing is slower than K alone would have it by what the play takes; twice round is enough.
  double share = 1, lag = 0, fast = 0;
  for (int i = 0; i < 4; ++i) {
    const double omega = std::sqrt((share * stiffness + loop.hand_stiffness) / loop.mass);
    fast = speed(omega);
    const double half = gear.play / 2, way = fast / omega; // of the handle, to either side
    if (way <= half) return true;                          // nothing of it is read
    const double part = half / way, root = std::sqrt(part * (1 - part));
    share = 0.5 + (std::asin(1 - 2 * part) + 2 * (1 - 2 * part) * root) / kPi;
    lag = 4 / kPi * part * (1 - part) / omega; // [s]
  }
  loop.damping += 4 * gear.friction / (kPi * fast) - stiffness * lag;
  return loop.damping >= 0 && spectralRadius(loop, share * stiffness) < 1;
}

} // namespace

double swingLimit(const SampledLoop& loop, const WornGear& gear,
                  const std::function<double(double)>& speed) {
  const double high = 4 * loop.mass / (loop.period * loop.period);
  double low = 1e-4 * high;
  if (!dies(loop, gear, low, speed)) return 0;
  double next = low;
  while (next < high && dies(loop, gear, next, speed)) low = next, next *= 1.1;
  return bisected(low, next, 1e-6, [&](double k) { return dies(loop, gear, k, speed); });
}

} // namespace patina
