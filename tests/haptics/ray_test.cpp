// The paper's literal contact point: K05 and K06.
#include "haptics/contact_fixture.h"

#include <gtest/gtest.h>

#include "core/work_precision.h"

namespace patina {
namespace {

Scene rayScene(double stiffness, Sampler sampler = Sampler::high) {
  Scene scene = sceneOf(stiffness, sampler);
  scene.haptics.contact = HapticProperties::Contact::ray;
  return scene;
}

// T-K06a. Coordinates that a float represents exactly are found exactly; others to the search's
// tolerance, a millionth of a voxel.
TEST(Ray, VcpOnAPlaneIsExact) {
  const auto snapshot = compileStages(rayScene(500), planeField());
  std::mt19937 random(1);
  std::uniform_int_distribution<int> dyadic(0, 1 << 12);
  const double unit = 0x1p-11 / (1 << 10);
  for (int i = 0; i < 2000; ++i) {
    const double x = 0x1p-11 * (dyadic(random) % 16), y = 0x1p-11 * (dyadic(random) % 16);
    const Vec3 tip(x, y, -(1 + dyadic(random)) * unit);
    const Contact contact = touchOnce(*snapshot, tip);
    EXPECT_LT((contact.vcp - Vec3(tip.x(), tip.y(), 0)).norm(), 1e-12);
  }
  std::uniform_real_distribution<double> any(-5e-3, 5e-3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 tip(any(random), any(random), -1e-9 - 0.4 * std::abs(any(random)));
    const Contact contact = touchOnce(*snapshot, tip);
    EXPECT_LT((contact.vcp - Vec3(tip.x(), tip.y(), 0)).norm(), 1e-6 * 0x1p-11);
  }
}

// T-K06b: order 2 of the contact point on a sphere, 1 to 4 mm deep, with the paper's sampler.
TEST(Ray, VcpOnASphereConvergesWithOrderTwo) {
  std::vector<double> voxels, errors;
  for (const int cells : {48, 72, 104, 150, 200}) {
    const Field sphere = sphereField(0.03, cells);
    const auto snapshot = compileStages(rayScene(500, Sampler::kim), sphere);
    std::mt19937 random(2);
    // The depth stays within every band: deeper, the coarse nodes give the direction.
    std::uniform_real_distribution<double> depth(0.3e-3, 1.4e-3);
    double sum = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 direction = randomDirection(random);
      const Contact contact = touchOnce(*snapshot, (0.03 - depth(random)) * direction);
      sum += (contact.vcp - 0.03 * direction).squaredNorm();
    }
    voxels.push_back(sphere->grid.voxel);
    errors.push_back(std::sqrt(sum / 4000));
  }
  EXPECT_NEAR(fittedOrder(voxels, errors), 2, 0.1);
}

// T-K06c and T-K06d, on a sphere and on a box with its creases.
TEST(Ray, VcpLiesOnTheSurfaceWithinTheBoundOnSamples) {
  const Field sphere = sphereField();
  const Field box =
      cubeField([](const Vec3& p) { return boxDistance(p, Vec3(0.03, 0.02, 0.025)); }, 0.5e-3, 150);
  for (const Field& field : {sphere, box}) {
    for (const Sampler sampler : {Sampler::kim, Sampler::high}) {
      const auto snapshot = compileStages(rayScene(500, sampler), field);
      const FieldSampler surface(*field, sampler);
      std::mt19937 random(3);
      std::uniform_real_distribution<double> coordinate(-0.03, 0.03);
      int tested = 0;
      for (int i = 0; i < 100000 && tested < 4000; ++i) {
        const Vec3 tip(coordinate(random), coordinate(random), coordinate(random));
        const GridSample at = surface.at(tip);
        if (at.phi >= 0 || at.region != FieldRegion::band || at.gradient.norm() < 0.9) continue;
        ++tested;
        const Contact contact = touchOnce(*snapshot, tip);
        EXPECT_LT(std::abs(surface.at(contact.vcp).phi), 1e-9);
        if (field == box) continue; // across a crease phi is not a distance along the ray
        const double voxels = contact.depth / field->grid.voxel;
        EXPECT_LE(contact.samples, static_cast<int>(std::ceil(voxels)) + 3);
      }
      EXPECT_GE(tested, 2000);
    }
  }
}

// K05: no direction at the centre of a plate: the last one is kept; without a last one there is no
// force.
TEST(Ray, KeepsTheLastDirectionIfThereIsNone) {
  const auto snapshot = compileStages(rayScene(500), plateField(0.8e-3));
  ContactMemory memory;
  tick(*snapshot, memory, Vec3(0, 0, 0.5e-3), 1e-3);
  tick(*snapshot, memory, Vec3(0, 0, 0.3e-3), 1e-3);
  const Contact middle = tick(*snapshot, memory, Vec3(0, 0, 0), 1e-3);
  EXPECT_NEAR(middle.force.z(), 500 * 0.4e-3, 1e-3);
  const Contact unknown = touchOnce(*snapshot, Vec3::Zero());
  EXPECT_TRUE(unknown.touching);
  EXPECT_EQ(unknown.force, Vec3::Zero().eval());
}

TEST(Ray, KeepsTheLastDirectionDeepWithoutCoarseNodes) {
  SurfaceField field = *planeField();
  field.coarse.clear();
  const auto snapshot = compileStages(rayScene(500), std::make_shared<const SurfaceField>(field));
  ContactMemory memory;
  tick(*snapshot, memory, Vec3(0, 0, 1e-4), 1e-3);
  const Contact contact = glide(*snapshot, memory, Vec3(0, 0, -0.013));
  EXPECT_TRUE(contact.deep);
  EXPECT_NEAR(contact.force.z(), 500 * 0.013, 1e-5);
}

// T-K12b without an offset: past the centre of a plate the force reverses, and this is reported.
TEST(Ray, ReversesPastTheMiddleOfAPlate) {
  const auto snapshot = compileStages(rayScene(500), plateField(0.8e-3));
  ContactMemory memory;
  glide(*snapshot, memory, Vec3(0, 0, 0.5e-3));
  EXPECT_NEAR(glide(*snapshot, memory, Vec3(0, 0, 0.05e-3), 1e-5).force.z(), 500 * 0.35e-3, 2e-3);
  const Contact turned = tick(*snapshot, memory, Vec3(0, 0, -0.05e-3), 1e-3);
  EXPECT_TRUE(turned.snap);
  EXPECT_NEAR(turned.force.z(), -500 * 0.35e-3, 2e-3);
  EXPECT_FALSE(turned.fault);
}

TEST(Ray, NewContactHasNoDisplacement) {
  const auto snapshot = compileStages(rayScene(500), plateField(0.8e-3));
  ContactMemory memory;
  glide(*snapshot, memory, Vec3(0, 0, 0.6e-3));
  glide(*snapshot, memory, Vec3(0, 0, 0.3e-3));
  for (const Vec3& free : {Vec3(0, 0, 1e-3), Vec3(4e-3, 0, 1e-3), Vec3(4e-3, 0, -1e-3)})
    EXPECT_FALSE(tick(*snapshot, memory, free, 1e-3).touching);
  const Contact again = tick(*snapshot, memory, Vec3(2e-3, 0, -0.3e-3), 1e-3);
  ASSERT_TRUE(again.touching);
  EXPECT_EQ(again.displacement, Vec3::Zero());
  EXPECT_FALSE(again.snap); // from the other side, without a step of its own
}

// K06: brute force along the ray, from deep inside a cube without one octant, where the slope of
// the blend may be anything.
TEST(Ray, FindsTheFirstCrossing) {
  const Field corner = cubeField(
      [](const Vec3& p) {
        const Vec3 half = Vec3::Constant(8);
        return std::max(boxDistance(p, half), -boxDistance(p - half, half));
      },
      1, 40);
  const auto snapshot = compileStages(rayScene(1, Sampler::kim), corner);
  const FieldSampler surface(*corner, Sampler::kim);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-8, 8);
  int crossings = 0, missed = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 tip(coordinate(random), coordinate(random), coordinate(random));
    const Contact contact = touchOnce(*snapshot, tip);
    if (!contact.touching || contact.normal.isZero()) continue;
    double first = 0;
    while (first < 8 && surface.at(tip + first * contact.normal).phi < 0) first += 1.0 / 64;
    if (first >= 8) continue;
    ++crossings;
    missed += std::abs(contact.depth - first) > 1.0 / 32;
  }
  EXPECT_GT(crossings, 1000);
  EXPECT_LE(missed, crossings / 1000); // 2 % if steps ignore the slope
}

} // namespace
} // namespace patina
