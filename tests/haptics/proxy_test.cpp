// The contact point near features that the field hardly resolves, and the cost of a tick. A voxel
// is a metre here.
#include "haptics/law/proxy_stage.h"

#include <gtest/gtest.h>

#include "haptics/contact_fixture.h"
#include "haptics/law/contact_memory.h"
#include "support/constants.h"

namespace patina {
namespace {

using test::kPeriod;

std::shared_ptr<const HapticSnapshot> felt(const Distance& phi, int cells = 48) {
  return compileStages(sceneOf(1), cubeField(phi, 1, cells));
}

// Moves the tip down to `place` and lets it rest there.
Contact resting(const HapticSnapshot& snapshot, ContactMemory& memory, const Vec3& place) {
  tick(snapshot, memory, Vec3(0, 0, 4), kPeriod);
  glide(snapshot, memory, place, 0.05);
  return glide(snapshot, memory, place, 1);
}

TEST(ProxyWay, MeetsASphereAtTheQuadraticsRoot) {
  const double radius = 12;
  const Field ball = cubeField([=](const Vec3& p) { return p.norm() - radius; }, 1, 48);
  const FieldSampler sampler(*ball, Sampler::high);
  const ProxySearch search(sampler, 0);
  const Vec3 middle = Vec3::Constant(24);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 400; ++i) {
    const Vec3 normal = randomDirection(random);
    const Vec3 along = (-2 * normal + randomDirection(random)).normalized();
    const Vec3 from = (radius + 0.02 + unit(random) * (i % 2 ? 0.4 : 4)) * normal;
    const double b = from.dot(along), c = from.squaredNorm() - radius * radius;
    if (b * b - c < 9) continue; // grazes
    const double way = -b - std::sqrt(b * b - c);
    const Vec3 to = from + (way + 0.1 + (i % 2 ? 0.3 : 3) * unit(random)) * along;
    int samples = 0;
    const auto at = search.firstCrossing(middle + from, search.heightAt(middle + from), middle + to,
                                         search.heightAt(middle + to), samples);
    ASSERT_TRUE(at);
    EXPECT_LT((*at - middle - from - way * along).norm(), 2e-3) << i;
    EXPECT_LE(samples, 12) << i;
  }
}

// Past the centre of a ball the nearest point is on the other side, and the contact point c moves
// there round the ball.
TEST(Proxy, RunningContactPointMovesByItsLimitWithOneReadATick) {
  const double radius = 10;
  const auto ball = felt([=](const Vec3& p) { return p.norm() - radius; }, 40);
  const double most = kSnapSides * 40 * kPeriod;
  ContactMemory memory;
  const Vec3 past(0.5, 0.2, -4);
  tick(*ball, memory, Vec3(0.5, 0.2, 11), kPeriod);
  Contact last = glide(*ball, memory, past, 2);
  int ran = 0, samples = 0;
  for (; ran < 1000 && last.frictionless_point.z() > -5; ++ran) {
    const Contact now = tick(*ball, memory, past, kPeriod);
    ASSERT_TRUE(now.snap);
    EXPECT_NEAR((now.frictionless_point - last.frictionless_point).norm(), most, 0.01 * most);
    EXPECT_NEAR(now.frictionless_point.norm(), radius, 0.01);
    samples += now.samples;
    last = now;
  }
  EXPECT_GT(ran, 300);
  EXPECT_LE(samples, 1.02 * ran);
}

// An edit resets the free distance. Relief may fall four times as fast as the distance to it.
TEST(Proxy, QuickTipMeetsTheFirstOfTwoPartsAfterAnEdit) {
  const Field parts =
      cubeField([](const Vec3& p) { return std::min(std::abs(p.z()) - 0.25, p.z() + 3); }, 1, 48);
  const ProxyStage stage(FieldSampler(*parts, Sampler::high), 0, 4);
  ContactMemory memory;
  memory.tip.last = Vec3(0.3, 0.2, 0.35);
  Contact contact;
  contact.tip = Vec3(0.3, 0.2, -3.3);
  contact.dt = kPeriod;
  stage.apply(contact, memory);
  ASSERT_TRUE(contact.touching);
  EXPECT_NEAR(contact.frictionless_point.z(), 0.25, 1e-3);
}

// Blended normals lean in a corner; their loads still add up to the vector to c.
TEST(Proxy, ThreeWallsShareTheDepthTheHeaviestFirst) {
  const auto corner = felt([](const Vec3& p) { return p.minCoeff(); });
  const Vec3 tip(-1.5, -2.5, -0.9);
  ContactMemory memory;
  tick(*corner, memory, Vec3(3, 3, 3), kPeriod);
  glide(*corner, memory, tip, 0.05);
  for (int i = 0; i < 20; ++i) {
    const Contact contact = tick(*corner, memory, tip, kPeriod);
    EXPECT_LT(contact.frictionless_point.norm(), 0.1);
    ASSERT_EQ(contact.walls, 3);
    Vec3 sum = Vec3::Zero();
    for (const Contact::WallLoad& wall : contact.wall) sum += wall.multiplier * wall.normal;
    EXPECT_LT((sum - (contact.frictionless_point - tip)).norm(), 1e-2);
    EXPECT_GE(contact.wall[0].multiplier, contact.wall[1].multiplier);
    EXPECT_GE(contact.wall[1].multiplier, contact.wall[2].multiplier);
    EXPECT_LE(contact.samples, 3);
  }
}

// A groove so flat that an evaluation at its centre mistakes either wall for the other.
TEST(Proxy, FlatGrooveHoldsTheRestingTipWithBothWalls) {
  const double lean = 0.2;
  const auto groove = felt(
      [=](const Vec3& p) { return std::cos(lean) * p.z() - std::sin(lean) * std::abs(p.x()); });
  ContactMemory memory;
  resting(*groove, memory, Vec3(0.05, 0.3, -1));
  for (int i = 0; i < 20; ++i) {
    const Contact contact = tick(*groove, memory, Vec3(0.05, 0.3, -1), kPeriod);
    EXPECT_LT((contact.frictionless_point - Vec3(0, 0.3, 0)).norm(), 2e-3);
    ASSERT_EQ(contact.walls, 2);
    EXPECT_NEAR(contact.wall[0].multiplier + contact.wall[1].multiplier, 1 / std::cos(lean), 2e-2);
    EXPECT_LE(contact.samples, 3);
  }
}

// One read a tick leaves c off by at most the field's own 9e-4 and the 3e-4 of an unfinished step.
TEST(Proxy, ReadsTheFieldOnceATickOnASmoothSurface) {
  const double radius = 20, depth = 2, step = 0.1;
  const Vec3 u = Vec3(3, 1, -2).normalized(), v = u.cross(Vec3(0.3, -0.2, 1)).normalized();
  for (const double side : {1.0, -1.0}) { // a ball, and a hollow
    const auto round = felt([=](const Vec3& p) { return side * (p.norm() - radius); }, 56);
    const double at = radius - side * depth;
    ContactMemory memory;
    tick(*round, memory, (radius + side) * u, kPeriod);
    glide(*round, memory, at * u, 0.2);
    int samples = 0;
    double worst = 0;
    for (int i = 1; i <= 200; ++i) {
      const double turn = step / at * i;
      const Vec3 outward = std::cos(turn) * u + std::sin(turn) * v;
      const Contact contact = tick(*round, memory, at * outward, kPeriod);
      ASSERT_GE(contact.samples, 1);
      samples += contact.samples;
      worst = std::max(worst, (contact.frictionless_point - radius * outward).norm());
    }
    EXPECT_LE(samples, 204) << side;
    EXPECT_LE(worst, 1.3e-3) << side;
  }
}

} // namespace
} // namespace patina
