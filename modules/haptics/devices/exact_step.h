// A mass with viscous damping, dry friction and a spring under a held force, moved exactly (F2).
#pragma once

namespace patina {

// m x'' + b x' + k x = F - fc sign(x'), x measured from the spring's rest.
struct Oscillator {
  double mass = 0.1;   // m [kg]
  double damping = 0;  // b [N s/m]
  double spring = 0;   // k [N/m]
  double friction = 0; // fc [N], Coulomb's: at rest it balances any force up to fc
};

struct Motion {
  double x = 0; // [m]
  double v = 0; // [m/s]
};

// x+ = xx x + xv v + xf F, v+ = vx x + vv v + vf F: one step without dry friction (MATH 2.1).
struct HeldStep {
  double xx, xv, xf, vx, vv, vf;
};
// Keeps its digits where b or k goes to zero and where b dt/m is large.
HeldStep heldStep(const Oscillator& body, double dt) noexcept;
// Where there is no mass, only a damper and a spring of this time constant b/k [s]: the share of
// the way to its rest that dt takes.
double masslessShare(double time_constant, double dt) noexcept;

// Steps of one length. With dry friction a step is cut where the velocity passes zero, so that it
// is exact there too; where the body then stays at rest, v is exactly 0.
class ExactStep {
 public:
  // Throws std::invalid_argument unless mass > 0, the rest >= 0 and everything is finite.
  ExactStep(const Oscillator& body, double dt);
  void setLength(double dt) noexcept; // dt >= 0 and finite; cheap where it stays
  Motion operator()(const Motion& from, double force) const noexcept;

 private:
  Oscillator body_;
  double dt_;
  HeldStep whole_;
};

} // namespace patina
