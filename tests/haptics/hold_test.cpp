#include "haptics/contact/active_constraints.h"

#include <numbers>

#include <gtest/gtest.h>

#include "haptics/contact_fixture.h"
#include "haptics/law/spring_stage.h"

namespace patina {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Vec3 leaning(double degrees) {
  return {std::sin(degrees * kDegree), 0, std::cos(degrees * kDegree)};
}

Contact heldBy(const std::vector<Contact::WallLoad>& walls) {
  Contact contact;
  contact.touching = true;
  contact.walls = static_cast<int>(walls.size());
  std::copy(walls.begin(), walls.end(), contact.wall.begin());
  return contact;
}

TEST(ActiveConstraints, MergeNearlyParallelWalls) {
  const Contact contact = heldBy({{leaning(5), 3e-5}, {leaning(-4), 2e-5}});
  const ActiveConstraints hold(contact);
  ASSERT_EQ(hold.count(), 1);
  const Vec3 sum = 3e-5 * leaning(5) + 2e-5 * leaning(-4);
  EXPECT_LT((hold[0].multiplier * hold[0].normal - sum).norm(), 1e-18);
  EXPECT_NEAR(hold[0].normal.norm(), 1, 1e-15);
}

// The active constraints bear the whole load, also next to a wall of their own.
TEST(ActiveConstraints, LoseNoLoad) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  int merged = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 middle = randomDirection(random);
    const double spread = std::pow(10.0, -2 * unit(random));
    std::vector<Contact::WallLoad> walls;
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 1 + i % 3; ++k) {
      walls.push_back({(middle + spread * randomDirection(random)).normalized(), 1 - 0.3 * k});
      sum += walls.back().multiplier * walls.back().normal;
    }
    const ActiveConstraints hold(heldBy(walls));
    Vec3 borne = Vec3::Zero();
    for (int k = 0; k < hold.count(); ++k) {
      borne += hold[k].multiplier * hold[k].normal;
      ASSERT_LT((hold.constrainedPart(hold[k].normal) - hold[k].normal).norm(), 1e-12) << i;
    }
    merged += hold.count() < static_cast<int>(walls.size());
    ASSERT_LT((borne - sum).norm(), 1e-12) << i;
  }
  EXPECT_GT(merged, 1000);
}

// If two walls bear the same load, either may come first.
TEST(ActiveConstraints, DoNotDependOnTheOrderOfWalls) {
  const ActiveConstraints a(heldBy({{leaning(5), 1.001e-5}, {leaning(-5), 1e-5}}));
  const ActiveConstraints b(heldBy({{leaning(-5), 1.001e-5}, {leaning(5), 1e-5}}));
  EXPECT_LT((a.constrainedPart(Vec3::UnitX()) - b.constrainedPart(Vec3::UnitX())).norm(), 1e-4);
}

// The sides of a cleft of 10 degrees leave only its line.
TEST(ActiveConstraints, KeepFacingWallsSeparate) {
  const ActiveConstraints hold(heldBy({{leaning(85), 1e-3}, {leaning(-85), 1e-3}}));
  ASSERT_EQ(hold.count(), 2);
  EXPECT_LT((hold.constrainedPart(Vec3(1, 2, 3)) - Vec3(1, 0, 3)).norm(), 1e-12);
}

// K08: the damper takes at most the force of the spring.
TEST(ActiveConstraints, DamperIsBoundedByTheLoadOfAllWalls) {
  const double load = 0.05e-3, stiffness = 1000;
  Contact contact = heldBy({{leaning(5), load}, {leaning(-5), load}});
  contact.normal = Vec3::UnitZ();
  contact.stiffness = stiffness;
  contact.force = stiffness * load * (leaning(5) + leaning(-5));
  contact.velocity = Vec3(0, 0, 0.1);
  dampConstrainedMotion(contact, 2, false);
  EXPECT_LT(contact.force.norm(), 1e-9);
}

} // namespace
} // namespace patina
