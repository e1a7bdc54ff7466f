// How often a registration warns of a correct pose, and how often it does not warn of a wrong one:
// scans of eight seconds, which hardly distinguish poses.
#include <cstdio>

#include <gtest/gtest.h>

#include "app/studies/acquisition/registration_consistency.h"
#include "support/longer.h"

namespace patina {
namespace {

constexpr double kRightPlace = 5e-3; // rms distance of the points; no other pose is as near [m]

struct Rates {
  int right = 0, warned = 0, wrong = 0, silent = 0;

  void add(const ConsistencyTrial& trial) {
    const bool is_right = trial.error < kRightPlace;
    (is_right ? right : wrong) += 1;
    if (is_right) warned += trial.warned;
    if (!is_right) silent += !trial.warned && trial.free == 0;
  }
};

Rates ratesOf(const TrustBody& body, const std::vector<unsigned>& seeds) {
  const SurfaceTarget target(body.mesh, 0, true);
  Progress progress;
  Rates rates;
  for (const unsigned seed : seeds) rates.add(trustTrial(target, 8, seed, progress));
  std::printf("%s: right %d, of which warned of %d; wrong %d, of which not warned of %d\n",
              body.name.c_str(), rates.right, rates.warned, rates.wrong, rates.silent);
  return rates;
}

// The first scans of a dinosaur from above, some of which are placed wrongly, and scans of a sheet
// whose bumps determine the pose.
TEST(RegistrationRates, WarnOfWrongPosesAndNotOfUniqueOnes) {
  const std::vector<TrustBody> bodies = trustBodies(4);
  const bool all = test::longer(1) > 1;
  std::vector<unsigned> seeds;
  for (unsigned seed = 1; seed <= 20; ++seed) seeds.push_back(seed);
  const Rates dinosaur = ratesOf(bodies[0], all ? seeds : std::vector<unsigned>{6, 20});
  EXPECT_GE(dinosaur.wrong, 1);
  EXPECT_EQ(dinosaur.silent, 0);
  const Rates sheet = ratesOf(bodies[3], all ? seeds : std::vector<unsigned>{1, 2, 3});
  EXPECT_EQ(sheet.wrong, 0);
  EXPECT_EQ(sheet.warned, 0);
  if (!all) return;
  const Rates stone = ratesOf(bodies[2], seeds);
  EXPECT_EQ(stone.silent, 0);
  EXPECT_LE(dinosaur.warned, 16); // 14 of 18
  EXPECT_LE(stone.warned, 6);     // 4 of 20
}

} // namespace
} // namespace patina
