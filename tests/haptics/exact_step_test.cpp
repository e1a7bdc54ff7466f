#include "haptics/loop_model/zoh_integrator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace patina {
namespace {

// Reference: many small steps of the classical Runge-Kutta method.
Motion integrated(const Oscillator& body, Motion m, double force, double dt) {
  constexpr int kSteps = 20000;
  const double h = dt / kSteps;
  const auto acceleration = [&](double x, double v) {
    return (force - body.damping * v - body.spring * x) / body.mass;
  };
  for (int i = 0; i < kSteps; ++i) {
    const double v1 = m.v, a1 = acceleration(m.x, v1);
    const double v2 = m.v + h / 2 * a1, a2 = acceleration(m.x + h / 2 * v1, v2);
    const double v3 = m.v + h / 2 * a2, a3 = acceleration(m.x + h / 2 * v2, v3);
    const double v4 = m.v + h * a3, a4 = acceleration(m.x + h * v3, v4);
    m.x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    m.v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return m;
}

TEST(ZohIntegrator, AgreesWithFineIntegrationWithAndWithoutSpring) {
  for (const double damping : {0., .5, 20., 300.})
    for (const double spring : {0., 1e-6, 40., 1e4})
      for (const double dt : {1e-4, 1e-3, 2e-2}) {
        const Oscillator body{.1, damping, spring, 0};
        const Motion from{2e-3, -.3};
        const Motion exact = ZohIntegrator(body, dt)(from, .7);
        const Motion reference = integrated(body, from, .7, dt);
        EXPECT_NEAR(exact.x, reference.x, 1e-13) << damping << " " << spring << " " << dt;
        EXPECT_NEAR(exact.v, reference.v, 1e-11) << damping << " " << spring << " " << dt;
      }
}

TEST(ZohIntegrator, SoftSpringApproachesNoSpring) {
  const ZohStep none = zohStep({.1, .5, 0, 0}, 1e-3), soft = zohStep({.1, .5, 1e-12, 0}, 1e-3);
  EXPECT_NEAR(soft.xf / none.xf, 1, 1e-11);
  EXPECT_NEAR(soft.vf / none.vf, 1, 1e-11);
  EXPECT_NEAR(soft.xv / none.xv, 1, 1e-11);
}

// x = b dt/m; (1 - e^-x)/x and its integral directly, or by series where they lose their digits.
TEST(ZohStep, MatchesTheClosedFormWithoutASpringAtAnyDamping) {
  const double m = .1, dt = 1e-3;
  for (const double x : {0., 1e-12, 1e-6, 1e-3, .3, 20., 1e3}) {
    const ZohStep step = zohStep({m, x * m / dt, 0, 0}, dt);
    const double c = x < 1e-4 ? 1 - x / 2 + x * x / 6 : -std::expm1(-x) / x;
    const double d = x < 1e-2 ? .5 - x / 6 + x * x / 24 - x * x * x / 120 : (1 - c) / x;
    EXPECT_NEAR(step.xx, 1, 1e-13) << x;
    EXPECT_EQ(step.vx, 0) << x;
    EXPECT_NEAR(step.vv, std::exp(-x), 1e-13 * std::exp(-x)) << x;
    EXPECT_NEAR(step.xv / (c * dt), 1, 1e-13) << x;
    EXPECT_NEAR(step.vf / (c * dt / m), 1, 1e-13) << x;
    EXPECT_NEAR(step.xf / (d * dt * dt / m), 1, 1e-12) << x;
  }
}

// T-ST1: a held force gives the same motion for any subdivision of its period.
TEST(ZohIntegrator, TwoHalfStepsEqualOneStep) {
  for (const double friction : {0., .2})
    for (const double spring : {0., 500.}) {
      const Oscillator body{.1, .5, spring, friction};
      const ZohIntegrator whole(body, 4e-3), part(body, 1e-3);
      const Motion from{1e-3, .005};
      Motion parts = from;
      for (int i = 0; i < 4; ++i) parts = part(parts, -.6);
      const Motion once = whole(from, -.6);
      EXPECT_NEAR(once.x, parts.x, 1e-16);
      EXPECT_NEAR(once.v, parts.v, 1e-14);
    }
}

// The undamped body travels v^2 / (2 fc/m) until it stops.
TEST(ZohIntegrator, DryFrictionStopsAtTheClosedForm) {
  const Oscillator body{.1, 0, 0, .2};
  const ZohIntegrator step(body, 1e-3);
  Motion m{0, .05};
  for (int i = 0; i < 100; ++i) m = step(m, 0);
  EXPECT_NEAR(m.x, .05 * .05 * .1 / (2 * .2), 1e-15);
  EXPECT_EQ(m.v, 0);
}

TEST(ZohIntegrator, DryFrictionHoldsUpToItsForceAndNoFurther) {
  const ZohIntegrator step({.1, .5, 0, .2}, 1e-3);
  EXPECT_EQ(step({3e-3, 0}, .2).x, 3e-3);
  EXPECT_EQ(step({3e-3, 0}, -.2).v, 0);
  EXPECT_GT(step({3e-3, 0}, .2001).v, 0);
  EXPECT_LT(step({3e-3, 0}, -.2001).v, 0);
}

// Each half swing of a spring with dry friction alone loses 2 fc/k of amplitude.
TEST(ZohIntegrator, SpringAndDryFrictionLoseTwoFcOverKAHalfSwing) {
  const Oscillator body{.1, 0, 1000, .5};
  const ZohIntegrator step(body, 0.02); // about two thirds of a half swing
  Motion m{10.3e-3, 0};
  for (int i = 0; i < 400; ++i) m = step(m, 0);
  // 10.3 mm loses 1 mm each time and rests where the spring is below fc/k = 0.5 mm.
  EXPECT_NEAR(std::abs(m.x), .3e-3, 1e-12);
  EXPECT_EQ(m.v, 0);
}

TEST(ZohIntegrator, RefusesInvalidBodies) {
  EXPECT_THROW(ZohIntegrator({0, 0, 0, 0}, 1e-3), std::invalid_argument);
  EXPECT_THROW(ZohIntegrator({.1, -1, 0, 0}, 1e-3), std::invalid_argument);
  EXPECT_THROW(ZohIntegrator({.1, 0, std::nan(""), 0}, 1e-3), std::invalid_argument);
  EXPECT_THROW(ZohIntegrator({.1, 0, 0, 0}, -1e-3), std::invalid_argument);
}

} // namespace
} // namespace patina
