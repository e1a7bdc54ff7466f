// Tests the judge of contact: no fault for the exact proxy, and each inserted fault is detected.
#include <gtest/gtest.h>

#include "app/studies/contact/contact_trials.h"
#include "app/studies/contact/scenes.h"
#include "core/percentiles.h"

namespace patina::test {
namespace {

constexpr double kVoxel = 0.75e-3; // [m]

TEST(ContactChecker, FindsNothingAgainstTheExactProxy) {
  for (const char* name : {"box", "L", "room", "wedge", "plate1", "bar", "groove", "dent",
                           "spheres", "torus", "galleon", "pottery", "rough"}) {
    const ContactScene scene = contactScene(name);
    const ExactSurface surface(scene.meshes);
    for (const double iso : scene.isos) {
      const unsigned seed = trialSeed(scene, iso, 3);
      const ContactMethod method = exactProxy(surface, iso, kVoxel);
      const TrialReport report = runTrials(method, surface, iso, 1000, seed);
      EXPECT_GE(report.contacts, 900) << name << ' ' << iso;
      EXPECT_EQ(report.lost + report.pulls + report.faults + report.unverified, 0) << name;
      EXPECT_LE(report.worst_excess, 1e-5) << name << ' ' << iso; // the slack of the ball
      EXPECT_LE(percentiles(report.error).max, 1e-3) << name << ' ' << iso;
      const LoopReport loops = runLoops(method, surface, iso, 2, seed);
      EXPECT_EQ(loops.loops, 2) << name << ' ' << iso;
      EXPECT_LE(loops.generated_energy, 2e-6)
          << name << ' ' << iso; // the error of the trapezium rule at a jump
    }
  }
}

// The exact proxy with its force replaced in the first tick that presses with more than 1 N.
TrialReport withOneBadTick(const std::function<void(Contact&)>& spoil) {
  const ExactSurface surface(contactScene("box").meshes);
  ContactMethod method = exactProxy(surface, 1e-3, kVoxel);
  bool done = false;
  method.tick = [&done, &spoil, exact = method.tick](const Vec3& tip, double dt) {
    Contact contact = exact(tip, dt);
    if (!done && contact.force.norm() > 1) {
      spoil(contact);
      done = true;
    }
    return contact;
  };
  std::vector<Vec3> tips;
  for (int i = 0; i < 200; ++i) tips.emplace_back(0.01, 0.01, 0.033 - 3e-5 * i);
  return runPath(method, surface, 1e-3, tips);
}

TEST(ContactChecker, DetectsEachFault) {
  const TrialReport sound = withOneBadTick([](Contact&) {});
  EXPECT_EQ(sound.lost + sound.pulls + sound.faults + sound.excesses, 0);
  EXPECT_GT(sound.contacts, 50);
  const TrialReport lost = withOneBadTick([](Contact& c) { c.force.setZero(); });
  EXPECT_EQ(lost.lost, 1);
  EXPECT_EQ(lost.excesses, 2); // down and up again
  EXPECT_NEAR(lost.worst_excess, 1, 0.1);
  const TrialReport pull = withOneBadTick([](Contact& c) { c.force *= -0.1; });
  EXPECT_EQ(pull.pulls, 1);
  EXPECT_EQ(pull.lost, 0);
  const TrialReport fault = withOneBadTick([](Contact& c) { c.fault = true; });
  EXPECT_EQ(fault.faults, 1);
  const TrialReport nan = withOneBadTick([](Contact& c) { c.force.x() = std::nan(""); });
  EXPECT_EQ(nan.faults, 1);
  EXPECT_EQ(nan.excesses, 2);
  EXPECT_GT(nan.worst_excess, 1e3);
  const TrialReport aside = withOneBadTick([](Contact& c) { c.force.x() += 0.04; });
  EXPECT_NEAR(percentiles(aside.error).max, 0.04, 1e-6);
  EXPECT_EQ(aside.excesses, 0);
}

TEST(ContactChecker, DetectsEnergyGeneratedByALoop) {
  const ExactSurface surface(contactScene("box").meshes);
  ContactMethod method = exactProxy(surface, 0, kVoxel);
  double loss = 0; // a force that is weaker while pressing than while releasing
  method.tick = [&loss, last = 0.0, exact = method.tick](const Vec3& tip, double dt) mutable {
    Contact contact = exact(tip, dt);
    const double depth = contact.depth;
    if (depth < last) contact.force *= 1 + loss;
    last = depth;
    return contact;
  };
  EXPECT_LE(runLoops(method, surface, 0, 5, 1).generated_energy, 2e-6);
  loss = 0.05;
  EXPECT_GT(runLoops(method, surface, 0, 5, 1).generated_energy, 1e-5);
}

} // namespace
} // namespace patina::test
