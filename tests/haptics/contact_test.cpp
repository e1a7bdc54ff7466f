#include "haptics/contact_fixture.h"

#include <gtest/gtest.h>

#include <limits>

namespace patina {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// T-K03. Float values resolve 6e-8 voxel, hence the small voxel.
TEST(Contact, FlipsAtThePlane) {
  const Field plane = planeField(0x1p-16);
  const auto snapshot = compileStages(sceneOf(500), plane);
  for (const double x : {0.0, 1.37e-4, -4.2e-4}) {
    EXPECT_FALSE(touchOnce(*snapshot, Vec3(x, x, 1e-12)).touching);
    EXPECT_TRUE(touchOnce(*snapshot, Vec3(x, x, -1e-12)).touching);
  }
}

// T-K03: a step over a thin plate ends on the side of entry.
TEST(Contact, StaysInFrontOfAThinPlateInOneStep) {
  const auto snapshot = compileStages(sceneOf(500), plateField());
  ContactMemory memory;
  const Vec3 tip(0.3e-3, 0.2e-3, 0.75e-3);
  EXPECT_FALSE(tick(*snapshot, memory, tip, 1e-3).touching);
  const Contact after = tick(*snapshot, memory, tip - Vec3(0, 0, 2e-3), 1e-3);
  ASSERT_TRUE(after.touching);
  EXPECT_LT((after.frictionless_point - Vec3(0.3e-3, 0.2e-3, 0.25e-3)).norm(), 1e-7);
  EXPECT_LT((after.normal - Vec3::UnitZ()).norm(), 1e-5);
}

TEST(Contact, SlidesAlongAThinPlateAndDetachesInFront) {
  const auto snapshot = compileStages(sceneOf(500), plateField());
  ContactMemory memory;
  tick(*snapshot, memory, Vec3(0, 0, 0.5e-3), 1e-3);
  tick(*snapshot, memory, Vec3(0, 0, -1e-3), 1e-3);
  const Contact slid = glide(*snapshot, memory, Vec3(1e-3, -0.5e-3, -1e-3));
  EXPECT_LT((slid.vcp - Vec3(1e-3, -0.5e-3, 0.25e-3)).norm(), 1e-6);
  EXPECT_NEAR(slid.force.z(), 500 * 1.25e-3, 1e-4);
  const Contact back = glide(*snapshot, memory, Vec3(1e-3, -0.5e-3, 0.3e-3));
  EXPECT_FALSE(back.touching);
  EXPECT_EQ(back.force, Vec3::Zero().eval());
}

TEST(Contact, StaysInFrontOfAThinPlateInASlowPush) {
  const auto snapshot = compileStages(sceneOf(500), plateField());
  ContactMemory memory;
  tick(*snapshot, memory, Vec3(0, 0, 0.5e-3), 1e-3);
  double last = 0;
  for (double z = 0.24e-3; z > -1.5e-3; z -= 0.01e-3) {
    const Contact contact = tick(*snapshot, memory, Vec3(0, 0, z), 1e-3);
    EXPECT_NEAR(contact.force.z(), 500 * (0.25e-3 - z), 2e-3) << z;
    EXPECT_GT(contact.force.z(), last) << z;
    last = contact.force.z();
  }
}

TEST(Contact, PassesAroundAnEdge) {
  const auto snapshot = compileStages(sceneOf(500), plateField());
  ContactMemory memory;
  tick(*snapshot, memory, Vec3(0, 0, 0.5e-3), 1e-3);
  tick(*snapshot, memory, Vec3(0, 0, -0.5e-3), 1e-3);
  ASSERT_TRUE(memory.contact.c);
  Contact beyond = glide(*snapshot, memory, Vec3(3.5e-3, 0, -0.5e-3), 0.05e-3);
  for (int i = 0; i < 300; ++i) beyond = tick(*snapshot, memory, Vec3(3.5e-3, 0, -0.5e-3), 1e-3);
  EXPECT_FALSE(beyond.touching);
}

TEST(Contact, PassesOverARoundBody) {
  const auto snapshot = compileStages(sceneOf(500), sphereField());
  ContactMemory memory;
  // Quick passes that dip 1 mm into the sphere and leave it behind the last tangent plane.
  for (double step = 0.5e-3; step < 6e-3; step *= 1.3) {
    memory.reset();
    for (double x = -0.03; x < 0.03; x += step) {
      const Vec3 tip(x, 0, 0.029);
      const Contact contact = tick(*snapshot, memory, tip, 1e-3);
      EXPECT_EQ(contact.touching, tip.norm() < 0.03) << step << ' ' << x;
    }
  }
}

// The contact stage skips the field inside a region that an earlier sample showed to be free.
TEST(Contact, FreeMotionTakesOneSampleOrNone) {
  const auto snapshot = compileStages(sceneOf(500), plateField());
  ContactMemory memory;
  int looks = 0;
  for (double z = 2e-3; z > 0.3e-3; z -= 0.01e-3) {
    const int samples = tick(*snapshot, memory, Vec3(0, 0, z), 1e-3).samples;
    EXPECT_LE(samples, 1);
    looks += samples;
  }
  EXPECT_LT(looks, 40); // 170 ticks
}

// T-K07.
TEST(Contact, ForceIsStiffnessTimesDepth) {
  const auto plane = compileStages(sceneOf(500), planeField());
  EXPECT_NEAR(touchOnce(*plane, Vec3(0.1e-3, 0.7e-3, -2e-3)).force.z(), 1.0, 1e-7);
  EXPECT_EQ(touchOnce(*plane, Vec3(0, 0, -0x1p-9)).force, Vec3(0, 0, 500 * 0x1p-9).eval());

  const Field sphere = sphereField();
  const double h = sphere->grid.voxel;
  const auto kim = compileStages(sceneOf(500, Sampler::kim), sphere);
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {
    const Contact contact = touchOnce(*kim, 0.028 * randomDirection(random));
    EXPECT_NEAR(contact.force.norm(), 1.0, 1.02 * 500 * h * h / (4 * 0.03));
  }
}

TEST(Contact, TipRadiusIsAnIsoValue) {
  Scene scene = sceneOf(500);
  scene.haptics.tip_radius = 1e-3;
  const auto snapshot = compileStages(scene, sphereField());
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    const Vec3 n = randomDirection(random);
    EXPECT_FALSE(touchOnce(*snapshot, 0.031001 * n).touching);
    const Contact contact = touchOnce(*snapshot, 0.030 * n);
    EXPECT_LT((contact.force - 0.5 * n).norm(), 4e-5);
    EXPECT_LT((contact.vcp - 0.031 * n).norm(), 1e-7);
  }
}

// MATH 2.8, a field deeper than the band.
TEST(Contact, ForceIsContinuousBeyondTheBand) {
  const Field sphere = sphereField();
  for (const Sampler sampler : {Sampler::kim, Sampler::high}) {
    const auto snapshot = compileStages(sceneOf(500, sampler), sphere);
    std::mt19937 random(6);
    for (int path = 0; path < 20; ++path) {
      const Vec3 n = randomDirection(random);
      ContactMemory memory;
      tick(*snapshot, memory, 0.0301 * n, 1e-3);
      Vec3 last = Vec3::Zero();
      for (double r = 0.03; r > 6e-3; r -= 0.02e-3) {
        const Contact contact = tick(*snapshot, memory, r * n, 1e-3);
        // The magnitude is exact along any valid direction; coarse cells are 3.6 mm wide.
        const double tolerance = r > 0.02 ? 2e-3 : r > 0.01 ? 0.02 : 0.08;
        EXPECT_LT((contact.force - 500 * (0.03 - r) * n).norm(),
                  tolerance * 500 * (0.03 - r) + 1e-3);
        EXPECT_LT((contact.force - last).norm(), 3 * 500 * 0.02e-3);
        EXPECT_FALSE(contact.fault);
        last = contact.force;
      }
    }
  }
}

// Past the centre of a solid body the tip is still inside: the force must neither reverse nor
// vanish.
TEST(Contact, KeepsTheForcePastTheMiddleOfASolid) {
  Scene scene = sceneOf(500);
  scene.haptics.force_limit = 3.3;
  const Field sphere = sphereField();
  for (const double aside : {0.0, 0.3e-3, 2e-3}) {
    const auto snapshot = compileStages(scene, sphere);
    ContactMemory memory;
    Vec3 last = Vec3::Zero();
    for (double z = 0.0305; z > -0.0295; z -= 0.02e-3) {
      const Vec3 tip(aside, 0.7 * aside, z);
      const Contact contact = tick(*snapshot, memory, tip, 1e-3);
      ASSERT_FALSE(contact.fault) << aside << ' ' << z;
      ASSERT_LT((contact.force - last).norm(), 0.5) << aside << ' ' << z;
      last = contact.force;
      const double depth = 0.03 - tip.norm();
      if (z < 0.0295 && depth > 0) {
        ASSERT_GT(contact.force.norm(), std::min(3.3, 500 * depth) * 0.9) << aside << ' ' << z;
      }
    }
  }
}

// F9: two spheres of 20 mm at +-10 mm joined by min. Finite and bounded everywhere inside.
TEST(Contact, JoinedSpheresStayFiniteAndBounded) {
  const Vec3 centre(0.01, 0, 0);
  const Field both = cubeField(
      [&](const Vec3& p) { return std::min((p - centre).norm(), (p + centre).norm()) - 0.02; },
      0.5e-3, 160);
  const auto snapshot = compileStages(sceneOf(500), both);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.03, 0.03);
  ContactMemory memory;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 tip(i % 5 ? coordinate(random) : 0, coordinate(random), coordinate(random));
    const Contact fresh = touchOnce(*snapshot, tip);
    const Contact tracked = tick(*snapshot, memory, tip, 1e-3);
    for (const Contact& contact : {fresh, tracked}) {
      EXPECT_TRUE(contact.force.allFinite());
      EXPECT_LE(contact.depth, 0.09); // the grid's half diagonal and more
    }
  }
}

TEST(Contact, BadTipsAreCountedAndForceless) {
  const auto snapshot = compileStages(sceneOf(500), planeField());
  ContactMemory memory;
  tick(*snapshot, memory, Vec3(0, 0, 1e-3), 1e-3);
  glide(*snapshot, memory, Vec3(0, 0, -1e-3));
  for (const double bad : {std::nan(""), kInfinity, -kInfinity}) {
    const Contact contact = tick(*snapshot, memory, Vec3(0, bad, 0), 1e-3);
    EXPECT_FALSE(contact.touching);
    EXPECT_EQ(contact.force, Vec3::Zero().eval());
  }
  // The contact state is kept: there is no fault and no spurious velocity.
  const Contact after = tick(*snapshot, memory, Vec3(0, 0, -1e-3), 1e-3);
  EXPECT_NEAR(after.force.z(), 0.5, 1e-6);
  EXPECT_FALSE(after.fault);

  const Contact outside = tick(*snapshot, memory, Vec3(1, 1, 1), 1e-3);
  EXPECT_FALSE(outside.touching);
}

} // namespace
} // namespace patina
