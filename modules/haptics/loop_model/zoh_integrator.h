// Exact integration of a mass with viscous damping, dry friction and a spring under a
// zero-order-hold force (Astrom & Wittenmark 1997; F2).
#pragma once

namespace patina {

// m x'' + b x' + k x = F - fc sign(x'), with x relative to the spring's rest.
struct Oscillator {
  double mass = 0.1;   // m [kg]
  double damping = 0;  // b [N s/m]
  double spring = 0;   // k [N/m]
  double friction = 0; // fc [N], Coulomb friction: at rest it balances forces up to fc
};

struct Motion {
  double x = 0; // [m]
  double v = 0; // [m/s]
};

// One step without dry friction (MATH 2.1): x+ = xx x + xv v + xf F, v+ = vx x + vv v + vf F.
struct ZohStep {
  double xx, xv, xf, vx, vv, vf;
};
// Accurate also if b or k approach zero, and if b dt/m is large.
ZohStep zohStep(const Oscillator& body, double dt) noexcept;
// Step response 1 - exp(-dt/tau) of a massless damper and spring, time constant b/k [s].
double firstOrderFraction(double time_constant, double dt) noexcept;

// Steps of constant length. With dry friction a step is split at each zero of the velocity, so that
// it stays exact; v is exactly 0 if the body then sticks.
class ZohIntegrator {
 public:
  // Throws std::invalid_argument unless mass > 0, the other values >= 0 and all are finite.
  ZohIntegrator(const Oscillator& body, double dt);
  void setLength(double dt) noexcept; // dt >= 0 and finite; fast if unchanged
  Motion operator()(const Motion& from, double force) const noexcept;

 private:
  Oscillator body_;
  double dt_;
  ZohStep whole_;
};

} // namespace patina
