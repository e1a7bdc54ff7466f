#include "haptics/loop_model/stability_limit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/decompose.h"
#include "haptics/loop_model/zoh_integrator.h"

namespace patina {
namespace {

constexpr double kRounding = 1e-12; // an eigenvalue magnitude up to 1 + this counts as stable
constexpr double kTolerance = 1e-10;

// States: x, v, step of x, filtered v, then the last `delay` forces, the newest first.
Eigen::MatrixXd transition(const SampledLoop& loop, double stiffness) {
  enum { x, v, step, filtered, first_force };
  const ZohStep held = zohStep({loop.mass, loop.damping, loop.hand_stiffness, 0}, loop.period);
  const int size = first_force + loop.delay;
  // vf becomes keep vf + (1 - keep) step/T, and the force of this tick uses it.
  double keep = 0;
  if (loop.cutoff) {
    const double time = 1 / (2 * std::numbers::pi * *loop.cutoff);
    keep = time / (time + loop.period);
  }
  Eigen::RowVectorXd velocity = Eigen::RowVectorXd::Zero(size);
  velocity[filtered] = keep;
  velocity[step] = (1 - keep) / loop.period;
  Eigen::RowVectorXd force = -loop.virtual_damping * velocity;
  force[x] -= stiffness;
  Eigen::RowVectorXd applied = force;
  if (loop.delay > 0) {
    applied.setZero();
    applied[size - 1] = 1;
  }

  Eigen::MatrixXd next = Eigen::MatrixXd::Zero(size, size);
  next.row(x) = held.xf * applied;
  next(x, x) += held.xx;
  next(x, v) += held.xv;
  next.row(v) = held.vf * applied;
  next(v, x) += held.vx;
  next(v, v) += held.vv;
  next.row(step) = next.row(x);
  next(step, x) -= 1;
  next.row(filtered) = velocity;
  if (loop.delay > 0) next.row(first_force) = force;
  for (int i = first_force + 1; i < size; ++i) next(i, i - 1) = 1;
  return next;
}

bool stable(const SampledLoop& loop, double stiffness) {
  return spectralRadius(loop, stiffness) <= 1 + kRounding;
}

// Returns the end of the stable range that starts at `from`, or 0 if `from` is unstable.
template <class Stable> double stableUpTo(double from, double far, const Stable& stableAt) {
  if (!stableAt(from)) return 0;
  double low = from, high = from;
  while (high < far) {
    high *= 1.25;
    if (!stableAt(high)) break;
    low = high;
  }
  while (high - low > kTolerance * high) {
    const double middle = 0.5 * (low + high);
    (stableAt(middle) ? low : high) = middle;
  }
  return low;
}

void check(const SampledLoop& loop) {
  if (!(loop.mass > 0 && loop.period > 0 && loop.damping >= 0 && loop.virtual_damping >= 0 &&
        loop.hand_stiffness >= 0 && loop.delay >= 0))
    throw std::invalid_argument("sampled loop: mass and period must be > 0, the rest >= 0");
}

} // namespace

SampledLoop sampledLoop(const DeviceModel& device, const HandModel& hand) {
  SampledLoop loop;
  loop.mass = device.mass + hand.mass;
  loop.damping = device.damping + hand.damping;
  loop.hand_stiffness = hand.stiffness;
  loop.period = 1 / device.rate;
  loop.delay = device.delay;
  return loop;
}

double spectralRadius(const SampledLoop& loop, double stiffness) {
  check(loop);
  const Eigen::MatrixXd whole = transition(loop, stiffness);
  const bool drifts = stiffness == 0 && loop.hand_stiffness == 0;
  const Eigen::Index first = drifts ? 1 : 0;
  const Eigen::Index size = whole.rows() - first;
  return eigenvaluesOf(whole.block(first, first, size, size)).cwiseAbs().maxCoeff();
}

double stiffnessLimit(const SampledLoop& loop) {
  check(loop);
  const double rule = linearStabilityLimit(loop);
  if (rule == 0) return 0;
  const double far = 1e3 * (rule + 4 * loop.mass / (loop.period * loop.period));
  return stableUpTo(1e-3 * rule, far, [&](double stiffness) { return stable(loop, stiffness); });
}

double dampingLimit(const SampledLoop& loop) {
  check(loop);
  const double scale = loop.mass / loop.period;
  return stableUpTo(1e-3 * scale, 1e3 * (scale + loop.damping), [&](double damping) {
    SampledLoop damped = loop;
    damped.virtual_damping = damping;
    return stable(damped, 0);
  });
}

double linearStabilityLimit(const SampledLoop& loop) {
  return (loop.damping + loop.virtual_damping) / ((0.5 + loop.delay) * loop.period);
}

} // namespace patina
