#include "app/studies/acquisition/registration_consistency.h"

#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

namespace patina {
namespace {

// The short form of the study's table: poses stated as certain are right, and the registration
// warns of the others.
TEST(RegistrationTrust, StatedErrorsHoldAndWrongPosesAreWarnedOf) {
  Progress progress;
  double nees = 0, unique = 0, wrong = 0, told = 0;
  for (const TrustBody& body : trustBodies(4)) {
    const SurfaceTarget target(body.mesh, 0, true);
    for (const double seconds : {4., 8., 20.}) {
      const ConsistencyTrial trial = trustTrial(target, seconds, 2, progress);
      const bool says = trial.warned || trial.free > 0;
      std::printf("%s, %g s: %.3f mm, %.1f deviations, NEES %.2f%s%s, %.2f s\n", body.name.c_str(),
                  seconds, 1e3 * trial.error, trial.deviations, trial.nees,
                  trial.warned ? ", warned" : "", trial.free > 0 ? ", free" : "", trial.seconds);
      wrong += trial.deviations > 5;
      told += trial.deviations > 5 && says;
      if (says) continue;
      nees += trial.nees;
      ++unique;
    }
  }
  ASSERT_GE(unique, 4);
  EXPECT_GT(nees / unique, 0.3);
  EXPECT_LT(nees / unique, 2);
  EXPECT_EQ(told, wrong);
}

} // namespace
} // namespace patina
