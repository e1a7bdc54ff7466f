// The lateral coupling by itself: its compliance, energy and cost, and where it is absent.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "haptics/law/coupling_stage.h"
#include "haptics/stability/stability_map.h"
#include "stability/texture_support.h"
#include "support/least_time.h"

namespace patina {
namespace {

// Returns the force at rest, `depth` beneath the relief's mean.
Contact restingAt(const HapticSnapshot& snapshot, ContactMemory& memory, const Vec3& tip) {
  Contact contact = glide(snapshot, memory, tip, 5e-6);
  for (int i = 0; i < 200; ++i) contact = tick(snapshot, memory, tip, 1e-3);
  return contact;
}

TEST(LateralCoupling, ValleyIsTheTextureAndTheCouplingInSeries) {
  for (const double amplitude : {50e-6, 100e-6})
    for (const double stiffness : {300.0, 2000.0}) {
      const Scene scene = automatic(stiffness);
      const HapticObject object = waves(amplitude);
      const auto snapshot = compileStages(scene, fineSlab().field, std::span(&object, 1));
      ASSERT_TRUE(snapshot->stabilisers.lateral);
      const double k_l = snapshot->stabilisers.lateral->stiffness;
      const Vec3 valley(0.5 * kWave, 1e-4, -3e-3);
      ContactMemory memory;
      glide(*snapshot, memory, Vec3(valley.x(), valley.y(), 2e-3));
      const double press = restingAt(*snapshot, memory, valley).force.z();
      const double texture = press * amplitude * kNumber * kNumber;
      const double s = 5e-6;
      const double ahead = restingAt(*snapshot, memory, valley + Vec3(s, 0, 0)).force.x();
      const double behind = restingAt(*snapshot, memory, valley - Vec3(s, 0, 0)).force.x();
      const double series = inSeries(texture, k_l);
      EXPECT_NEAR((behind - ahead) / (2 * s), series, 0.01 * series) << amplitude;
      EXPECT_LT(series, k_l);
    }
}

// Compares forces at rest at any place and depth; a jump lowers the force, which frees the tip.
TEST(LateralCoupling, IsNowhereStifferThanItsSpring) {
  for (const double amplitude : {50e-6, 100e-6}) {
    const Scene scene = automatic(500);
    const HapticObject object = waves(amplitude);
    const auto snapshot = compileStages(scene, fineSlab().field, std::span(&object, 1));
    const double k_l = snapshot->stabilisers.lateral->stiffness;
    for (const double depth : {1e-3, 3e-3, 6e-3}) {
      ContactMemory memory;
      const double step = 4e-6;
      double last = restingAt(*snapshot, memory, Vec3(0, 1e-4, -depth)).force.x(), stiffest = 0;
      for (int i = 1; i < 500; ++i) {
        const double now = restingAt(*snapshot, memory, Vec3(step * i, 1e-4, -depth)).force.x();
        stiffest = std::max(stiffest, (last - now) / step);
        last = now;
      }
      EXPECT_LE(stiffest, k_l) << amplitude << " " << depth;
      EXPECT_GT(stiffest, 0.2 * k_l) << amplitude << " " << depth;
    }
  }
}

// Returns the work given to the hand over the second of two rounds, when the stored energy is
// periodic too.
double workOfLoop(const HapticSnapshot& snapshot, const std::vector<Vec3>& corners, double step) {
  ContactMemory memory;
  double work = 0;
  restingAt(snapshot, memory, corners.back());
  Vec3 tip = corners.back(), force = tick(snapshot, memory, tip, 1e-3).force;
  for (int round = 0; round < 2; ++round) {
    work = 0;
    for (const Vec3& corner : corners) {
      const Vec3 from = tip;
      const int count = static_cast<int>(std::ceil((corner - from).norm() / step));
      for (int i = 1; i <= count; ++i) {
        const Vec3 next = from + static_cast<double>(i) / count * (corner - from);
        const Vec3 now = tick(snapshot, memory, next, 1e-3).force;
        work += 0.5 * (now + force).dot(next - tip);
        tip = next;
        force = now;
      }
    }
  }
  return work;
}

TEST(LateralCoupling, LoopOverTextureGivesNoEnergy) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> aside(-2e-3, 2e-3), deep(-5e-3, 0.3e-3);
  double most = -1, least = 1;
  for (const Texture& texture : stiffTextures()) {
    const auto snapshot = compiledOn(texture, automatic(500));
    for (int i = 0; i < 20; ++i) {
      std::vector<Vec3> corners;
      for (int k = 0; k < 4; ++k) corners.emplace_back(aside(random), aside(random), deep(random));
      for (const double step : {2e-6, 20e-6}) { // 2 and 20 mm/s
        const double work = workOfLoop(*snapshot, corners, step);
        EXPECT_LE(work, 1e-8) << texture.name << " " << i;
        most = std::max(most, work);
        least = std::min(least, work);
      }
    }
  }
  std::printf("texture: %.3g ... %.3g J given a loop\n", least, most);
}

// A loop without jumps loses energy only to the damper, in proportion to the speed.
TEST(LateralCoupling, SlowLoopWithoutJumpsLosesNothing) {
  const Scene scene = automatic(500);
  const HapticObject object = waves(40e-6);
  const auto snapshot = compileStages(scene, fineSlab().field, std::span(&object, 1));
  const std::vector<Vec3> corners{Vec3(1.3e-3, 1e-4, -2e-3), Vec3(1.3e-3, 1e-4, -1.2e-3),
                                  Vec3(0, 1e-4, -1.2e-3), Vec3(0, 1e-4, -2e-3)};
  const double quick = workOfLoop(*snapshot, corners, 5e-7);
  const double slow = workOfLoop(*snapshot, corners, 1.25e-7);
  EXPECT_LT(quick, 0);
  EXPECT_NEAR(slow / quick, 0.25, 0.01);
}

// 100 um under 2 N have several equilibria within the coupling's range, and the tip takes the next
// one: no fault, and no slip in the sense of friction.
TEST(LateralCoupling, ReportsJumpsWithoutFault) {
  for (const double amplitude : {50e-6, 100e-6}) {
    const Scene scene = withFriction(automatic(500), 0.3, 0.25);
    const HapticObject object = waves(amplitude);
    const auto snapshot = compileStages(scene, fineSlab().field, std::span(&object, 1));
    ContactMemory memory;
    const double depth = amplitude < 75e-6 ? 2e-3 : 4e-3;
    restingAt(*snapshot, memory, Vec3(0, 1e-4, -depth));
    int snaps = 0;
    for (int i = 0; i < 6000; ++i) {
      const Contact contact = tick(*snapshot, memory, Vec3(1e-6 * i, 1e-4, -depth), 1e-3);
      snaps += contact.snap;
      ASSERT_FALSE(contact.fault) << i;
    }
    if (amplitude < 75e-6)
      EXPECT_EQ(snaps, 0);
    else
      EXPECT_GE(snaps, 5); // waves
  }
}

void expectSameForces(const HapticSnapshot& a, const HapticSnapshot& b, double depth) {
  ContactMemory memory_a, memory_b;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 tip(2e-3 * std::sin(0.011 * i), 2e-3 * std::sin(0.007 * i),
                   depth * std::sin(0.01 * i));
    const Contact left = tick(a, memory_a, tip, 1e-3), right = tick(b, memory_b, tip, 1e-3);
    ASSERT_EQ(left.force, right.force) << i;
    ASSERT_EQ(left.lateral_offset, Vec3::Zero());
  }
}

Scene upTo(double force_limit, Scene scene) {
  scene.haptics.force_limit = force_limit;
  return scene;
}

// A texture that the loop can render at full force needs no such stage; its forces and cost are
// unchanged.
TEST(LateralCoupling, IsAbsentWhereTheTextureIsGentle) {
  const HapticObject gentle = waves(10e-6), stiff = waves(50e-6);
  const Field& field = fineSlab().field;
  const auto with = compileStages(upTo(1, automatic(300)), field, std::span(&gentle, 1));
  EXPECT_FALSE(with->stabilisers.lateral);
  EXPECT_FALSE(hasLateral(*with));
  expectSameForces(*with, *compileStages(upTo(1, bare(300)), field, std::span(&gentle, 1)), 2e-3);

  EXPECT_TRUE(hasLateral(*compileStages(upTo(3, automatic(300)), field, std::span(&gentle, 1))));
  EXPECT_TRUE(hasLateral(*compileStages(upTo(1, automatic(300)), field, std::span(&stiff, 1))));
  EXPECT_FALSE(hasLateral(*compileStages(bare(300), field, std::span(&stiff, 1))));
  EXPECT_FALSE(hasLateral(*compileStages(sceneOf(300), field, std::span(&stiff, 1))));
  Scene literal = automatic(300); // this form has no force along the surface
  literal.relief.form = ForceForm::literal;
  EXPECT_FALSE(hasLateral(*compileStages(literal, field, std::span(&stiff, 1))));
}

// The whole top belongs to the second object.
std::array<HapticObject, 2> stiffAndGentle() {
  const auto& triangles = fineSlab().mesh->triangles;
  std::int32_t top = 0;
  const auto isTop = [&](std::int32_t f) {
    for (int k = 0; k < 3; ++k)
      if (fineSlab().mesh->corner(static_cast<std::size_t>(f), k).z() < -1e-9) return false;
    return true;
  };
  while (top < static_cast<std::int32_t>(triangles.size()) && !isTop(top)) ++top;
  EXPECT_GT(top, 0);
  std::array<HapticObject, 2> objects{waves(50e-6), waves(10e-6)};
  objects[1].first_face = top;
  return objects;
}

// The coupling is per object: the stiff texture of one does not change the force of the other.
TEST(LateralCoupling, DoesNotChangeTheGentleTextureOfAnotherObject) {
  const std::array<HapticObject, 2> objects = stiffAndGentle();
  const auto with = compileStages(upTo(1, automatic(300)), fineSlab().field, objects);
  ASSERT_TRUE(hasLateral(*with));
  expectSameForces(*with, *compileStages(upTo(1, bare(300)), fineSlab().field, objects), 2e-3);
}

// The probe presses without the force limit, but applies it to the verdict.
TEST(LateralCoupling, ProbeSeesTheGentleTextureOfAnotherObjectUnchanged) {
  const std::array<HapticObject, 2> objects = stiffAndGentle();
  const Vec3 valley(0.5 * kWave, 1e-4, 0);
  const auto lateralOf = [&](std::span<const HapticObject> felt) {
    const auto at = StiffnessProbe(upTo(1, automatic(300)), fineSlab().field, felt).at(valley);
    EXPECT_TRUE(at);
    return at ? at->lateral_stiffness : -1;
  };
  EXPECT_EQ(lateralOf(objects), 0);
  EXPECT_GT(lateralOf(std::span(objects).first(1)), 0); // this object alone decides
}

// The map is for the rendered scene: stable with the coupling.
TEST(LateralCoupling, MapIncludesTheCoupling) {
  TriangleMesh points; // a map uses only the vertices
  for (int i = 0; i < 400; ++i)
    points.positions.emplace_back(kWave / 20 * (i % 20), kWave / 20 * (i / 20), 0);
  Progress progress;
  for (const Texture& texture : stiffTextures())
    for (const double stiffness : {300.0, 2000.0}) {
      const auto mapOf = [&](const Scene& scene) {
        const HapticObject object = texture.on(scene);
        return stabilityMap(scene, texture.field, points, progress, std::span(&object, 1));
      };
      const StabilityMap with = mapOf(automatic(stiffness)), without = mapOf(bare(stiffness));
      std::printf("%s, K %.0f: worst ratio %.2f (%zu jump), without %.2f\n", texture.name,
                  stiffness, with.worst_ratio, with.discontinuous_count, without.worst_ratio);
      EXPECT_EQ(with.buzzing, 0u) << texture.name << " " << stiffness;
      EXPECT_GT(with.worst_ratio, 1) << texture.name << " " << stiffness;
      EXPECT_LT(without.worst_ratio, 0.7) << texture.name << " " << stiffness;
    }
}

TEST(LateralCoupling, MapsStiffnessOfAValleyIsTheSeries) {
  const Scene scene = automatic(500);
  const HapticObject object = waves(50e-6);
  const std::span<const HapticObject> objects(&object, 1);
  const StiffnessProbe probe(scene, fineSlab().field, objects);
  const auto at = probe.at(Vec3(0.5 * kWave, 1e-4, 0));
  ASSERT_TRUE(at);
  const double series = inSeries(at->force * object.max_curvature, at->lateral_stiffness);
  EXPECT_NEAR(at->matrix(0, 0), series, 0.01 * series);
}

// Ratio of a tick's time over stiff texture to one without the coupling.
PATINA_TIMED_TEST(LateralCouplingTiming, ATickCostsLittleMore) {
  for (const Texture& texture : stiffTextures()) {
    const auto with = compiledOn(texture, automatic(500)), without = compiledOn(texture, bare(500));
    const auto slide = [](const HapticSnapshot& snapshot) {
      return [&snapshot] {
        ContactMemory memory;
        for (int i = 0; i < 2000; ++i)
          tick(snapshot, memory, Vec3(2e-6 * i, 1e-6 * i, -2e-3), 1e-3);
      };
    };
    const std::vector<double> seconds = test::minSeconds({slide(*with), slide(*without)});
    std::printf("%s: a tick %.0f ns, %.0f without: %.2f\n", texture.name, 5e5 * seconds[0],
                5e5 * seconds[1], seconds[0] / seconds[1]);
    EXPECT_LT(seconds[0] / seconds[1], 3) << texture.name;
  }
}

} // namespace
} // namespace patina
