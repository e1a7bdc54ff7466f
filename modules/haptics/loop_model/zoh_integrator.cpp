#include "haptics/loop_model/zoh_integrator.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <Eigen/Core>
#include <unsupported/Eigen/MatrixFunctions>

namespace patina {
namespace {

constexpr int kMaxCrossings = 64;   // per step; faster oscillations are not those of a hand
constexpr double kRounding = 1e-12; // tolerance of a force that equals the friction
constexpr double kNever = std::numeric_limits<double>::infinity();

Motion moved(const ZohStep& s, const Motion& m, double force) noexcept {
  return {s.xx * m.x + s.xv * m.v + s.xf * force, s.vx * m.x + s.vv * m.v + s.vf * force};
}

// Time of the next zero of the velocity under a constant force; v e^(st) = v0 C(t) + w0 S(t), with
// C and S cos and sin, 1 and t, or cosh and sinh.
double nextRest(const Oscillator& body, const Motion& m, double force) noexcept {
  const double s = 0.5 * body.damping / body.mass;
  const double square = s * s - body.spring / body.mass;
  const double w0 = (force - body.damping * m.v - body.spring * m.x) / body.mass + s * m.v;
  const double q = std::sqrt(std::abs(square));
  if (square < 0) {
    double angle = std::atan(-m.v * q / w0);
    if (angle <= 0) angle += std::numbers::pi;
    return angle / q;
  }
  const double t = -m.v / w0;
  if (!(t > 0)) return kNever;
  if (!(t * q > 1e-150)) return t;
  return t * q < 1 ? std::atanh(t * q) / q : kNever;
}

} // namespace

ZohStep zohStep(const Oscillator& body, double dt) noexcept {
  Eigen::Matrix3d rate; // third state: F/m
  rate << 0, 1, 0, -body.spring / body.mass, -body.damping / body.mass, 1, 0, 0, 0;
  const Eigen::Matrix3d step = (dt * rate).exp();
  return {step(0, 0), step(0, 1), step(0, 2) / body.mass,
          step(1, 0), step(1, 1), step(1, 2) / body.mass};
}

double firstOrderFraction(double time_constant, double dt) noexcept {
  return -std::expm1(-dt / time_constant);
}

ZohIntegrator::ZohIntegrator(const Oscillator& body, double dt) : body_(body), dt_(dt) {
  const bool sound = body.mass > 0 && body.damping >= 0 && body.spring >= 0 && body.friction >= 0 &&
                     dt >= 0 &&
                     std::isfinite(body.mass + body.damping + body.spring + body.friction + dt);
  if (!sound) throw std::invalid_argument("exact step: mass must be > 0 and the rest >= 0");
  whole_ = zohStep(body, dt);
}

void ZohIntegrator::setLength(double dt) noexcept {
  if (dt == dt_) return;
  assert(dt >= 0 && std::isfinite(dt));
  dt_ = dt;
  whole_ = zohStep(body_, dt);
}

Motion ZohIntegrator::operator()(const Motion& from, double force) const noexcept {
  if (body_.friction == 0) return moved(whole_, from, force);
  Motion m = from;
  double left = dt_;
  for (int i = 0; i < kMaxCrossings && left > 0; ++i) {
    const double drive = m.v != 0 ? m.v : force - body_.spring * m.x;
    if (m.v == 0 && std::abs(drive) <= body_.friction * (1 + kRounding)) return m;
    const double net = force - std::copysign(body_.friction, drive);
    const double rest = nextRest(body_, m, net);
    if (rest >= left) return moved(i == 0 ? whole_ : zohStep(body_, left), m, net);
    m = moved(zohStep(body_, rest), m, net);
    m.v = 0;
    left -= rest;
  }
  return m;
}

} // namespace patina
