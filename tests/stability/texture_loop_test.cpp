// A mass on a texture that is stiffer along the surface than the loop bears (F7): the lateral
// coupling keeps it quiet, and does not touch what needs none.
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "haptics/coupling_stage.h"
#include "haptics/painted_fixture.h"
#include "haptics/simulation.h"
#include "haptics/stability_map.h"
#include "support/least_time.h"

namespace patina {
namespace {

constexpr double kWave = 1e-3;                           // [m]
constexpr double kNumber = 2 * std::numbers::pi / kWave; // [1/m]
constexpr double kVoxel = 0x1p-11;

// Highest at the middle of the slab; `amplitude` (1 - cos).
FeltObject waves(double amplitude, bool crossed = false) {
  static const auto along = reliefImage(
      1024, [](double u, double) { return std::cos(kNumber * Slab::kSide * (u - 0.5)); });
  static const auto both = reliefImage(1024, [](double u, double v) {
    return 0.5 * (std::cos(kNumber * Slab::kSide * (u - 0.5)) +
                  std::cos(kNumber * Slab::kSide * (v - 0.5)));
  });
  FeltObject object = feltRelief(fineSlab().faces, crossed ? both : along, amplitude);
  object.bend = amplitude * kNumber * kNumber;
  return object;
}

FeltObject rough(double rms, const Scene& scene) {
  return feltMaterial(*coveredMap(kVoxel, cube(12e-3), MaterialChannel::roughness,
                                  [=](const Vec3&) { return rms; }),
                      scene);
}

Scene automatic(double stiffness) {
  Scene scene = sceneOf(stiffness);
  scene.device_model = DeviceModel{};
  return scene;
}

Scene bare(double stiffness) {
  Scene scene = automatic(stiffness);
  scene.stabilisers = Stabilisers{};
  return scene;
}

struct Texture {
  const char* name;
  std::function<FeltObject(const Scene&)> on;
  Field field;
};
std::vector<Texture> stiffTextures() {
  const Field slab = fineSlab().field;
  return {{"50 um", [](const Scene&) { return waves(50e-6); }, slab},
          {"100 um", [](const Scene&) { return waves(100e-6); }, slab},
          {"100 um, crossed", [](const Scene&) { return waves(100e-6, true); }, slab},
          {"roughness 50 um", [](const Scene& scene) { return rough(50e-6, scene); },
           planeField(kVoxel, 96)}};
}
constexpr double kStiffnesses[] = {200, 500, 1000, 2000};

std::shared_ptr<const HapticSnapshot> compiledOn(const Texture& texture, const Scene& scene) {
  const FeltObject object = texture.on(scene);
  return compileStages(scene, texture.field, std::span(&object, 1));
}

// A mass under 1 N that comes down off every line of symmetry.
SimulationSpec comesDown(const Scene& scene) {
  SimulationSpec spec;
  spec.device = *scene.device_model;
  spec.surface = Vec3(0.2e-3, 0.13e-3, 0.2e-3);
  spec.press = 1;
  spec.speed = 0.05;
  spec.seconds = 24;
  return spec;
}

SimulationReport felt(const Texture& texture, const Scene& scene, const SimulationSpec& spec,
                      const RowSink& row = {}) {
  Progress progress;
  return simulate(*compiledOn(texture, scene), spec, progress, row);
}

// What the coupling is for.
TEST(TextureLoop, BuzzesOrLeavesWithoutTheLateralCoupling) {
  for (const Texture& texture : stiffTextures())
    for (const double stiffness : kStiffnesses) {
      const Scene scene = bare(stiffness);
      EXPECT_GT(felt(texture, scene, comesDown(scene)).rms_velocity, 0.01)
          << texture.name << " " << stiffness;
    }
}

TEST(TextureLoop, RestsAtAnyStiffnessByItselfInAHandAndWithJitter) {
  double worst = 0;
  for (const Texture& texture : stiffTextures())
    for (const double stiffness : kStiffnesses)
      for (const bool held : {false, true})
        for (const bool jitter : {false, true}) {
          const Scene scene = automatic(stiffness);
          SimulationSpec spec = comesDown(scene);
          if (held) spec.hand = {0.05, 1, 100};
          if (jitter) spec.jitter = PeriodRange{0.5e-3, 2e-3};
          const SimulationReport run = felt(texture, scene, spec);
          EXPECT_LE(run.rms_velocity, 1e-6) << texture.name << " " << stiffness << held << jitter;
          EXPECT_TRUE(run.touches_late);
          EXPECT_EQ(run.fault_ticks, 0u);
          worst = std::max(worst, run.rms_velocity);
        }
  std::printf("texture: at rest to %.2g m/s\n", worst);
}

// k_l and B are planned from the device: heavy and light, quick and late.
TEST(TextureLoop, CalmsDownOnAnyDeviceThatDamps) {
  Progress progress;
  for (const double mass : {0.02, 0.1, 0.5})
    for (const double damping : {0.1, 0.5, 5.0})
      for (const double rate : {500.0, 1000.0, 4000.0})
        for (const int delay : {0, 2, 5})
          for (const double amplitude : {50e-6, 200e-6}) {
            Scene scene = automatic(1000);
            scene.device_model = DeviceModel{mass, damping, 0, 0, rate, delay};
            const FeltObject object = waves(amplitude, true);
            const auto snapshot = compileStages(scene, fineSlab().field, std::span(&object, 1));
            SimulationSpec spec = comesDown(scene);
            spec.press = 0.5;
            spec.seconds = 12;
            const SimulationReport run = simulate(*snapshot, spec, progress);
            const std::string what = "m " + std::to_string(mass) + " b " + std::to_string(damping) +
                                     " rate " + std::to_string(rate) + " n " +
                                     std::to_string(delay);
            EXPECT_TRUE(run.verdict == Verdict::kAtRest || run.verdict == Verdict::kCalmingDown)
                << what << ": " << run.rms_velocity << ", early " << run.rms_early;
            EXPECT_EQ(run.fault_ticks, 0u) << what;
          }
}

// An encoder alone lets nothing rest that is stiffer than nothing: between two of its steps there
// is no force, and the tip wanders from one to the other, on a plane too. That is as still as it
// gets.
TEST(TextureLoop, WithAnEncoderAndJitterItStaysWithinThreeSteps) {
  const double step = 20e-6;
  double worst = 0;
  for (const Texture& texture : stiffTextures())
    for (const double stiffness : kStiffnesses) {
      Scene scene = automatic(stiffness);
      scene.device_model->encoder_step = step;
      SimulationSpec spec = comesDown(scene);
      spec.jitter = PeriodRange{0.5e-3, 2e-3};
      Vec3 low = Vec3::Constant(1), high = -low;
      felt(texture, scene, spec, [&](const SimulationRow& row) {
        if (row.t < spec.seconds - 1) return;
        low = low.cwiseMin(row.position);
        high = high.cwiseMax(row.position);
      });
      EXPECT_LE((high - low).maxCoeff(), 3 * step) << texture.name << " " << stiffness;
      worst = std::max(worst, (high - low).maxCoeff());
    }
  std::printf("texture: with an encoder of 20 um within %.3g um\n", 1e6 * worst);
}

// 2.2: the dry friction of a device locks it.
TEST(TextureLoop, WithAnEncoderAndDryFrictionItRests) {
  for (const Texture& texture : stiffTextures())
    for (const double stiffness : kStiffnesses) {
      Scene scene = automatic(stiffness);
      scene.device_model->encoder_step = 20e-6;
      scene.device_model->coulomb = 0.05;
      SimulationSpec spec = comesDown(scene);
      spec.jitter = PeriodRange{0.5e-3, 2e-3};
      spec.depth = -5e-3;
      EXPECT_EQ(felt(texture, scene, spec).rms_velocity, 0) << texture.name << " " << stiffness;
    }
}

// The force with everything at rest, `depth` beneath the relief's mean.
Contact restingAt(const HapticSnapshot& snapshot, ContactMemory& memory, const Vec3& tip) {
  Contact contact = glide(snapshot, memory, tip, 5e-6);
  for (int i = 0; i < 200; ++i) contact = tick(snapshot, memory, tip, 1e-3);
  return contact;
}

TEST(LateralCoupling, AValleyIsTheTextureAndTheCouplingInSeries) {
  for (const double amplitude : {50e-6, 100e-6})
    for (const double stiffness : {300.0, 2000.0}) {
      const Scene scene = automatic(stiffness);
      const FeltObject object = waves(amplitude);
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

// At any place and depth, where it is at rest; what it falls by in a hop frees the tip.
TEST(LateralCoupling, IsNowhereStifferThanItsSpring) {
  for (const double amplitude : {50e-6, 100e-6}) {
    const Scene scene = automatic(500);
    const FeltObject object = waves(amplitude);
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

// Work given to the hand over the second of two rounds, when what is stored has come round too.
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

TEST(LateralCoupling, NoLoopOverTextureGivesEnergy) {
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

// Without hops nothing is lost but to the damper, in proportion to the speed.
TEST(LateralCoupling, ASlowLoopWithoutHopsLosesNothing) {
  const Scene scene = automatic(500);
  const FeltObject object = waves(50e-6);
  const auto snapshot = compileStages(scene, fineSlab().field, std::span(&object, 1));
  const std::vector<Vec3> corners{Vec3(1.3e-3, 1e-4, -2e-3), Vec3(1.3e-3, 1e-4, -1.2e-3),
                                  Vec3(0, 1e-4, -1.2e-3), Vec3(0, 1e-4, -2e-3)};
  const double quick = workOfLoop(*snapshot, corners, 5e-7);
  const double slow = workOfLoop(*snapshot, corners, 1.25e-7);
  EXPECT_LT(quick, 0);
  EXPECT_NEAR(slow / quick, 0.25, 0.01);
}

// 100 um under 2 N have more than one rest within the coupling's reach, and the tip takes the next
// one: no fault, and nothing that friction would call a slip of the hand's.
TEST(LateralCoupling, HopsAreSaidAndAreNoFault) {
  for (const double amplitude : {50e-6, 100e-6}) {
    const Scene scene = withFriction(automatic(500), 0.3, 0.25);
    const FeltObject object = waves(amplitude);
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

bool hasLateral(const HapticSnapshot& snapshot) {
  return std::any_of(snapshot.why.begin(), snapshot.why.end(),
                     [](const StageInfo& stage) { return stage.name == "lateral coupling"; });
}

void expectSameForces(const HapticSnapshot& a, const HapticSnapshot& b, double depth) {
  ContactMemory memory_a, memory_b;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 tip(2e-3 * std::sin(0.011 * i), 2e-3 * std::sin(0.007 * i),
                   depth * std::sin(0.01 * i));
    const Contact left = tick(a, memory_a, tip, 1e-3), right = tick(b, memory_b, tip, 1e-3);
    ASSERT_EQ(left.force, right.force) << i;
    ASSERT_EQ(left.aside, Vec3::Zero());
  }
}

// A texture that the loop bears has no such stage, and costs and feels what it did.
TEST(LateralCoupling, IsAbsentWhereTheTextureIsGentle) {
  const FeltObject gentle = waves(10e-6), stiff = waves(50e-6);
  const Field& field = fineSlab().field;
  const auto with = compileStages(automatic(300), field, std::span(&gentle, 1));
  EXPECT_FALSE(with->stabilisers.lateral);
  EXPECT_FALSE(hasLateral(*with));
  expectSameForces(*with, *compileStages(bare(300), field, std::span(&gentle, 1)), 2e-3);

  EXPECT_TRUE(hasLateral(*compileStages(automatic(300), field, std::span(&stiff, 1))));
  EXPECT_FALSE(hasLateral(*compileStages(bare(300), field, std::span(&stiff, 1))));
  EXPECT_FALSE(hasLateral(*compileStages(sceneOf(300), field, std::span(&stiff, 1))));
  Scene literal = automatic(300); // which has no force along the surface
  literal.relief.form = ForceForm::literal;
  EXPECT_FALSE(hasLateral(*compileStages(literal, field, std::span(&stiff, 1))));
}

// By object: the stiff texture of one is not what the other is felt by.
TEST(LateralCoupling, LeavesTheGentleTextureOfAnotherObjectAsItIs) {
  const auto& triangles = fineSlab().mesh->triangles;
  std::int32_t top = 0;
  const auto isTop = [&](std::int32_t f) {
    for (int k = 0; k < 3; ++k)
      if (fineSlab().mesh->corner(static_cast<std::size_t>(f), k).z() < -1e-9) return false;
    return true;
  };
  while (top < static_cast<std::int32_t>(triangles.size()) && !isTop(top)) ++top;
  ASSERT_GT(top, 0);
  std::array<FeltObject, 2> objects{waves(50e-6), waves(10e-6)};
  objects[1].first_face = top;
  const auto with = compileStages(automatic(300), fineSlab().field, objects);
  ASSERT_TRUE(hasLateral(*with));
  expectSameForces(*with, *compileStages(bare(300), fineSlab().field, objects), 2e-3);
}

// The map is of the scene as it is felt: calm with the coupling.
TEST(LateralCoupling, TheMapSeesTheTextureThroughIt) {
  TriangleMesh points; // of a map only the vertices count
  for (int i = 0; i < 400; ++i)
    points.positions.emplace_back(kWave / 20 * (i % 20), kWave / 20 * (i / 20), 0);
  Progress progress;
  for (const Texture& texture : stiffTextures())
    for (const double stiffness : {300.0, 2000.0}) {
      const auto mapOf = [&](const Scene& scene) {
        const FeltObject object = texture.on(scene);
        return stabilityMap(scene, texture.field, points, progress, std::span(&object, 1));
      };
      const StabilityMap with = mapOf(automatic(stiffness)), without = mapOf(bare(stiffness));
      std::printf("%s, K %.0f: worst ratio %.2f (%zu jump), without %.2f\n", texture.name,
                  stiffness, with.worst_ratio, with.jumping, without.worst_ratio);
      EXPECT_EQ(with.buzzing, 0u) << texture.name << " " << stiffness;
      EXPECT_GT(with.worst_ratio, 1) << texture.name << " " << stiffness;
      EXPECT_LT(without.worst_ratio, 0.7) << texture.name << " " << stiffness;
    }
}

TEST(LateralCoupling, TheMapsStiffnessOfAValleyIsTheSeries) {
  const Scene scene = automatic(500);
  const FeltObject object = waves(50e-6);
  const std::span<const FeltObject> objects(&object, 1);
  const StiffnessProbe probe(scene, fineSlab().field, objects);
  const auto at = probe.at(Vec3(0.5 * kWave, 1e-4, 0));
  ASSERT_TRUE(at);
  const double series = inSeries(at->force * object.bend, at->lateral);
  EXPECT_NEAR(at->matrix(0, 0), series, 0.01 * series);
}

// Where the surface itself turns: in a bowl, and on a ball, where a hand must keep the tip.
TEST(TextureLoop, RestsOnCurvedSurfaces) {
  struct Case {
    const char* name;
    Field field;
    double z; // [m], of the surface
    HandModel hand;
  };
  const std::vector<Case> cases = {
      {"bowl",
       cubeField([](const Vec3& p) { return 0.02 - p.norm(); }, 0.5e-3, 100, 10),
       -0.02,
       {}},
      {"ball",
       cubeField([](const Vec3& p) { return p.norm() - 0.01; }, 0.5e-3, 64, 10),
       0.01,
       {0.05, 1, 400}}};
  for (const Case& c : cases)
    for (const double stiffness : {500.0, 2000.0}) {
      Scene scene = automatic(stiffness);
      scene.haptics.tip_radius = 1e-3;
      const FeltObject object = rough(50e-6, scene);
      const auto snapshot = compileStages(scene, c.field, std::span(&object, 1));
      ASSERT_TRUE(snapshot->stabilisers.lateral);
      SimulationSpec spec = comesDown(scene);
      spec.surface = Vec3(0.2e-3, 0.13e-3, c.z + 1.6e-3);
      spec.hand = c.hand;
      Progress progress;
      const SimulationReport run = simulate(*snapshot, spec, progress);
      EXPECT_LE(run.rms_velocity, 1e-6) << c.name << " " << stiffness;
      EXPECT_TRUE(run.touches_late);
      EXPECT_EQ(run.fault_ticks, 0u);
    }
}

// Ratio of a tick over stiff texture to one without the coupling.
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
    const std::vector<double> seconds = test::leastSeconds({slide(*with), slide(*without)});
    std::printf("%s: a tick %.0f ns, %.0f without: %.2f\n", texture.name, 5e5 * seconds[0],
                5e5 * seconds[1], seconds[0] / seconds[1]);
    EXPECT_LT(seconds[0] / seconds[1], 3) << texture.name;
  }
}

} // namespace
} // namespace patina
