// Texture stages, one tick of each against brute force on their height.
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "haptics/law/contact_memory.h"
#include "haptics/law/lateral_stage.h"
#include "haptics/law/relief_stage.h"
#include "haptics/painted_fixture.h"

namespace patina {
namespace {

constexpr double kStiffness = 1000, kRough = 40e-6, kPull = 800; // [N/m], [m rms], [N/m]

// Pressed `depth` into the plane z = 0 above it at `place`.
Contact pressed(const Vec3& place, double depth) {
  Contact contact;
  contact.touching = true;
  contact.dt = 1e-3;
  contact.tip = place - depth * Vec3::UnitZ();
  contact.surface = contact.frictionless_point = contact.vcp = place;
  contact.normal = Vec3::UnitZ();
  contact.depth = depth;
  contact.walls = 1;
  contact.wall[0] = {contact.normal, depth};
  contact.material.stiffness = kStiffness;
  contact.material.roughness = kRough;
  return contact;
}

struct Tie {
  std::array<HapticObject, 1> object;
  LateralStage stage;
  explicit Tie(double damping)
      : object{HapticObject{}}, stage(nullptr, object, 0, {kPull, damping, -1}) {}
};

double energy(const Vec3& place, double depth, const Vec3& aside) {
  const double deep = std::max(depth + kRough * roughPattern(place + aside).height, 0.0);
  return 0.5 * kPull * aside.squaredNorm() + 0.5 * kStiffness * deep * deep;
}

TEST(LateralStage, RestsAtALocalEnergyMinimum) {
  const Tie tie(0);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-5e-3, 5e-3);
  double farthest = 0;
  for (int i = 0; i < 40; ++i) {
    const Vec3 place(any(random), any(random), 0);
    const double depth = 0.5e-3 + 0.2 * std::abs(any(random));
    ContactMemory memory;
    memory.lateral.surface = place;
    Contact contact;
    for (int k = 0; k < 30; ++k) {
      contact = pressed(place, depth);
      tie.stage.apply(contact, memory);
    }
    EXPECT_EQ(contact.lateral_stiffness, kPull);
    EXPECT_NEAR(contact.lateral_offset.z(), 0, 1e-15);
    farthest = std::max(farthest, contact.lateral_offset.norm());
    const double here = energy(place, depth, contact.lateral_offset), step = 2e-6;
    EXPECT_LE(here, energy(place, depth, Vec3::Zero()));
    for (int k = 0; k < 8; ++k) {
      const double angle = k * std::numbers::pi / 4;
      const Vec3 beside = contact.lateral_offset + step * Vec3(std::cos(angle), std::sin(angle), 0);
      EXPECT_GE(energy(place, depth, beside), here - 1e-4 * step) << i; // [N] of a rest
    }
  }
  EXPECT_GT(farthest, 20e-6);
}

TEST(LateralStage, ReportsTextureThatOutrunsTheTip) {
  const Tie tie(0);
  const Vec3 place(0.1, 0.05, 0);
  for (const double drawn : {0.0, 2e-3}) {
    int runs = 0, snaps = 0;
    for (int i = 0; i < 60; ++i) {
      ContactMemory memory;
      Contact contact = pressed(place + 0.05e-3 * i * Vec3::UnitX(), 4e-3);
      memory.lateral.surface = contact.surface - drawn * Vec3::UnitX();
      tie.stage.apply(contact, memory);
      runs += contact.lateral_offset.norm() > 0.1e-3; // 0.1 m/s
      snaps += contact.snap;
    }
    EXPECT_GT(runs, 10);
    EXPECT_EQ(snaps, drawn > 0 ? 0 : runs);
  }
}

// The gradient of the spring's energy makes the force conservative; the papers' form keeps the
// normal.
TEST(RoughnessStage, RaisesTheSurfaceByItsPattern) {
  const Field plane = planeField(0x1p-11, 16);
  const std::array<HapticObject, 1> object{};
  const double shell = kRoughnessPeak * kRough;
  const auto forceAt = [&](ForceForm form, const Vec3& place, double depth) {
    const RoughnessStage stage(FieldSampler(*plane, Sampler::high), object, shell, form);
    Contact contact = pressed(place, depth + shell);
    contact.frictionless_point.z() = contact.vcp.z() = shell;
    ContactMemory memory;
    stage.apply(contact, memory);
    return Vec3(kStiffness * contact.depth * contact.normal);
  };
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-2e-3, 2e-3);
  const double depth = 0.6e-3, step = 1e-7;
  double squares = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 place(any(random), any(random), 0);
    const auto stored = [&](const Vec3& by) {
      const double deep =
          depth - by.z() + kRough * roughPattern(place + Vec3(by.x(), by.y(), 0)).height;
      return 0.5 * kStiffness * deep * deep;
    };
    Vec3 expected;
    for (int axis = 0; axis < 3; ++axis)
      expected[axis] =
          (stored(-step * Vec3::Unit(axis)) - stored(step * Vec3::Unit(axis))) / (2 * step);
    EXPECT_LT((forceAt(ForceForm::conservative, place, depth) - expected).norm(), 1e-4);
    const Vec3 literal = forceAt(ForceForm::literal, place, depth);
    EXPECT_LT((literal - expected.z() * Vec3::UnitZ()).norm(), 1e-4);
    squares += std::pow(literal.z() / kStiffness - depth, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / 200), kRough, 0.2 * kRough);
  EXPECT_EQ(forceAt(ForceForm::literal, Vec3(1e-3, 0, 0), -shell - 1e-6), Vec3::Zero());
}

// K05: a contact without a direction, such as between two parts. Relief gives it none.
TEST(ReliefStage, HasNoEffectOnAContactWithoutDirection) {
  const Slab& plane = fineSlab();
  const std::array<HapticObject, 1> object{
      hapticRelief(plane.faces, reliefImage(64, [](double u, double) { return u; }), 2e-3)};
  const FieldSampler sampler(*plane.field, Sampler::high);
  const auto reliefs = std::make_shared<const Reliefs>(sampler, object);
  const ReliefStage stage(reliefs, 2e-3, ForceForm::conservative);
  ContactMemory memory;
  Contact contact = pressed(Vec3(1e-3, 0, 0), 5e-3);
  contact.normal.setZero();
  contact.walls = 0;
  stage.apply(contact, memory);
  EXPECT_TRUE(contact.touching);
  EXPECT_EQ(contact.normal, Vec3::Zero());
  EXPECT_NEAR(contact.depth, 3e-3, 1e-12); // beneath the shell
}

// The pattern has no mirror symmetry and no maximum at the origin.
TEST(RoughPattern, HasNoSymmetryAboutTheOrigin) {
  std::mt19937 random(6);
  double squares = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = 5e-3 * randomDirection(random);
    squares += std::pow(roughPattern(p).height - roughPattern(-p).height, 2);
  }
  EXPECT_GT(squares / 500, 0.5); // 2 if the two are uncorrelated
  EXPECT_LT(std::abs(roughPattern(Vec3::Zero()).height), 0.7 * kRoughnessPeak);
}

} // namespace
} // namespace patina
