#include "acquisition/simulation/simulated_hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace patina {
namespace {

// Applies every move that has begun, one after the other.
HandState byAllMoves(const SimulatedHand& hand, double t) {
  Vec2 place = hand.from;
  double force = 0, lift = 1, begin = 0;
  for (const HandMove& move : hand.moves) {
    const double x = std::clamp((t - begin) / move.seconds, 0., 1.);
    const double share = x * x * x * (10 - 15 * x + 6 * x * x);
    const Vec2 along = move.to - place;
    const double sine = std::sin(std::numbers::pi * share);
    if (along.norm() > 0)
      place +=
          share * along + move.lateral_bow * sine * sine * Vec2(-along.y(), along.x()).normalized();
    force += share * (move.force - force);
    lift += share * (move.lift - lift);
    begin += move.seconds;
  }
  HandState state;
  state.force = force;
  state.tip = Vec3(place.x(), place.y(), lift * hand.travel_height);
  if (force > 0) state.tip.z() -= hand.compliance * force;
  return state;
}

TEST(SimulatedHand, IsWhereItsMovesTakeIt) {
  SimulatedHand hand = strokes(3, 30);
  hand.tilt = hand.tremor = hand.tremor_tilt = hand.force_noise = 0;
  const HandCourse course(hand);
  for (double t = -1; t < hand.seconds() + 1; t += 0.0137) {
    const HandState expected = byAllMoves(hand, t), found = handAt(course, t);
    ASSERT_LT((found.tip - expected.tip).norm(), 1e-12) << t;
    ASSERT_NEAR(found.force, expected.force, 1e-12) << t;
    ASSERT_EQ(found.touching, found.force > 0);
    ASSERT_EQ(handAt(hand, t).tip, found.tip);
  }
}

TEST(SimulatedHand, RestsWithoutMoves) {
  SimulatedHand hand;
  hand.tremor = 0;
  hand.from = Vec2(1, 2);
  for (const double t : {-1., 0., 7.}) {
    EXPECT_EQ(handAt(hand, t).tip, Vec3(1, 2, hand.travel_height));
    EXPECT_FALSE(handAt(hand, t).touching);
  }
}

} // namespace
} // namespace patina
