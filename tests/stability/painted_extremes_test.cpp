// Painted surfaces at their limits (MATH 2.7, 2.8): stiffness from 1 to 1e7 N/m across a cell,
// cliffs, checkerboards and seams of relief, in the closed loop and by hand.
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "haptics/law/coupling_stage.h"
#include "haptics/loop_model/stability_limit.h"
#include "haptics/painted_fixture.h"
#include "haptics/simulation/simulation.h"
#include "haptics/stability/stability_map.h"
#include "stability/texture_support.h"

namespace patina {
namespace {

std::shared_ptr<const HapticSnapshot> compiledWith(const Scene& scene, const HapticObject& object,
                                                   const Field& field) {
  return compileStages(scene, field, std::span(&object, 1));
}

HapticObject halves(const Scene& scene, double k1, double k2) {
  return hapticMaterial(*coveredMap(kVoxel, cube(12e-3), MaterialChannel::stiffness,
                                    [=](const Vec3& p) { return p.x() > 0 ? k2 : k1; }),
                        scene);
}

// The stiffest paint decides, not the scene's own value.
TEST(PaintedStiffness, CouplingIsPlannedForTheStiffestPaint) {
  Scene scene = sceneOf(300);
  scene.device_model = DeviceModel{};
  const Field plane = planeField(kVoxel);
  EXPECT_FALSE(compileStages(scene, plane)->stabilisers.coupling);
  const auto stiff = compiledWith(scene, halves(scene, 300, 1e5), plane);
  ASSERT_TRUE(stiff->stabilisers.coupling);
  const double k_c = stiff->stabilisers.coupling->stiffness;
  const auto displayed = [&](double x) {
    ContactMemory memory;
    glide(*stiff, memory, Vec3(x, 0, -1e-3));
    return tick(*stiff, memory, Vec3(x, 0, -1e-3), 1e-3).force.z() / 1e-3;
  };
  EXPECT_NEAR(displayed(4e-3), inSeries(1e5, k_c), 1);
  EXPECT_NEAR(displayed(-4e-3), inSeries(300, k_c), 1);
}

TEST(PaintedStiffness, LoopBuzzesAtThePredictedLimitAndTheCouplingStopsIt) {
  const Field plane = planeField(kVoxel);
  for (const double share : {0.9, 1.1}) {
    Scene scene = sceneOf(300);
    const double limit = stiffnessLimit(sampledLoop(DeviceModel{}));
    const HapticObject object = halves(scene, 300, share * limit);
    SimulationSpec spec;
    spec.surface = Vec3(5e-3, 1e-3, 0);
    spec.depth = 1 / (share * limit);
    spec.speed = 1e-4;
    spec.press = 1;
    spec.seconds = 20;
    Progress progress;
    const auto bare = simulate(*compiledWith(scene, object, plane), spec, progress);
    EXPECT_EQ(bare.stable, share < 1) << share;
    scene.device_model = DeviceModel{};
    EXPECT_TRUE(simulate(*compiledWith(scene, object, plane), spec, progress).stable);
  }
}

// K from 1 to 1e7 within one cell of half a millimetre: gradients of 2e10 N/m^2. The tip is pressed
// next to the step, on it and slid over it.
TEST(PaintedStiffness, ForceStaysBoundedFromOneToTenMillionAcrossACell) {
  const Field plane = planeField(kVoxel, 96);
  for (const ForceForm form : {ForceForm::conservative, ForceForm::literal})
    for (const bool coupled : {true, false}) {
      Scene scene = sceneOf(300);
      scene.material_form = form;
      scene.haptics.force_limit = 3.3;
      if (coupled) scene.device_model = DeviceModel{};
      const auto snapshot = compiledWith(scene, halves(scene, 1, 1e7), plane);
      // Slides over the edge at every depth.
      for (const double d : {1e-5, 1e-3, 4e-3}) {
        ContactMemory memory;
        glide(*snapshot, memory, Vec3(-3e-3, 1e-4, -d));
        for (int i = 0; i <= 300; ++i) {
          const Contact contact = tick(*snapshot, memory, Vec3(-3e-3 + 2e-5 * i, 1e-4, -d), 1e-3);
          ASSERT_TRUE(contact.force.allFinite());
          ASSERT_LE(contact.force.norm(), 3.3);
          ASSERT_FALSE(contact.fault) << d << " " << i;
        }
      }
      for (const double x : {-1e-3, 0.0, 0.2e-3, 0.4e-3, 2e-3}) {
        SimulationSpec spec;
        spec.surface = Vec3(x, 1e-4, 0);
        spec.depth = -1e-3;
        spec.speed = 0.05;
        spec.press = 0.01; // the soft side can bear it within the grid
        spec.seconds = 6;
        Progress progress;
        const SimulationReport run = simulate(*snapshot, spec, progress);
        std::printf("%s %s x = %.1f mm: %s, rms %.2g m/s, gained %.2g J, depth %.2g mm\n",
                    coupled ? "coupled" : "bare",
                    form == ForceForm::literal ? "literal" : "conservative", 1e3 * x,
                    name(run.verdict), run.rms_velocity, run.energy_gained, 1e3 * run.max_depth);
        EXPECT_TRUE(std::isfinite(run.rms_velocity));
        EXPECT_LE(run.max_force, 3.3);
        EXPECT_EQ(run.fault_ticks, 0u);
        if (coupled) {
          EXPECT_LT(run.rms_velocity, 0.1);
        }
      }
    }
}

// The form is conservative also at that ratio, if the path is fine enough to resolve the step.
TEST(PaintedStiffness, ConservativeFormDoesNoWorkAtAnyRatio) {
  const Field plane = planeField(kVoxel);
  for (const double k2 : {1e3, 1e5, 1e7}) {
    const Scene scene = sceneOf(300);
    Scene wide = scene;
    wide.haptics.force_limit = std::numeric_limits<double>::infinity();
    const auto snapshot = compiledWith(wide, halves(scene, 1, k2), plane);
    const double d = 1e-3, theory = 0.5 * k2 * d * d;
    const std::vector<Vec3> corners{Vec3(1e-3, 0, -d), Vec3(1e-3, 0, 1e-4), Vec3(-1e-3, 0, 1e-4),
                                    Vec3(-1e-3, 0, -d)};
    const double work = loopWork(*snapshot, corners, 5000);
    EXPECT_LT(std::abs(work), 0.01 * theory) << k2;
  }
}

// MATH 2.1.7 with F6: on the slope between two paints the directions are coupled by d grad K.
TEST(PaintedStiffness, MapIncludesTheStiffestPaint) {
  const Field plane = planeField(kVoxel);
  Scene scene = sceneOf(200);
  const HapticObject object = halves(scene, 200, 3000);
  const std::span<const HapticObject> objects(&object, 1);
  const StiffnessProbe probe(scene, plane, objects);
  const auto soft = probe.at(Vec3(-4e-3, 0, 0)), stiff = probe.at(Vec3(4e-3, 0, 0));
  ASSERT_TRUE(soft && stiff);
  EXPECT_NEAR(soft->lambda_max, 200, 1);
  EXPECT_NEAR(stiff->lambda_max, 3000, 15);
  EXPECT_NEAR(stiff->depth, 1.0 / 3000, 1e-9);
  EXPECT_EQ(stiff->material.stiffness, 3000);
  const StiffnessLimits limits = loopLimits(scene, objects);
  EXPECT_NEAR(stabilityRatio(*soft, scene, limits) / stabilityRatio(*stiff, scene, limits), 15,
              0.1);
  const auto between = probe.at(Vec3(0.5 * kVoxel, 0, 0), 1e-3);
  ASSERT_TRUE(between);
  const double cross = 1e-3 * 2800 / kVoxel; // d grad K
  EXPECT_NEAR(between->matrix(2, 0), -cross, 0.02 * cross);
  EXPECT_NEAR(between->matrix(0, 2), -cross, 0.02 * cross); // a potential's matrix is symmetric
}

// Slides over the slab along x at y; the worst force and whether anything faulted.
struct Ride {
  double most = 0;
  int faults = 0;
  bool finite = true;
};
Ride ride(const HapticSnapshot& snapshot, double speed, double z) {
  Ride result;
  ContactMemory memory;
  glide(snapshot, memory, Vec3(-5e-3, 1e-4, 7e-3), 1e-4);
  glide(snapshot, memory, Vec3(-5e-3, 1e-4, z), 1e-4);
  for (double x = -5e-3; x < 5e-3; x += speed * 1e-3) {
    const Contact contact = tick(snapshot, memory, Vec3(x, 1e-4 + 0.3 * x, z), 1e-3);
    result.most = std::max(result.most, contact.force.norm());
    result.faults += contact.fault;
    result.finite &= contact.force.allFinite();
  }
  return result;
}

HapticObject reliefOf(int size, double height, const std::function<double(double, double)>& g) {
  return hapticRelief(fineSlab().faces, reliefImage(size, g), height);
}

// A step of 5 mm, a checkerboard at texel frequency, a line of one texel, all white.
TEST(PaintedRelief, CliffsAndCheckerboardsAreBoundedAndNoFault) {
  struct Case {
    const char* name;
    HapticObject object;
  };
  const auto check = [](double u, double v) {
    return (static_cast<int>(u * 512) + static_cast<int>(v * 512)) % 2 ? 1.0 : 0.0;
  };
  const std::vector<Case> cases = {
      {"step of 5 mm", reliefOf(512, 5e-3, [](double u, double) { return u > 0.5 ? 1 : 0; })},
      {"engraved step", reliefOf(512, -5e-3, [](double u, double) { return u > 0.5 ? 1 : 0; })},
      {"checkerboard of 1 mm", reliefOf(512, 1e-3, check)},
      {"line of a texel",
       reliefOf(512, 2e-3,
                [](double u, double) { return static_cast<int>(u * 512) == 256 ? 1 : 0; })},
      {"white", reliefOf(64, 3e-3, [](double, double) { return 1; })}};
  for (const Case& c : cases)
    for (const ForceForm form : {ForceForm::conservative, ForceForm::literal})
      for (const int kind : {0, 1, 2, 3}) {
        const bool coupled = kind & 1;
        Scene scene = sceneOf(500);
        if (kind & 2) {
          scene = withFriction(scene, 0.4, 0.3);
          scene.haptics.damping = 1;
        }
        scene.haptics.force_limit = 3.3;
        scene.relief.form = form;
        if (coupled) scene.stabilisers = Stabilisers{true, true};
        const auto snapshot = compiledWith(scene, c.object, fineSlab().field);
        for (const double speed : {0.01, 0.2, 1.0})
          for (const double z : {4e-3, 1e-3, -1e-3, -3e-3}) {
            const Ride result = ride(*snapshot, speed, z);
            EXPECT_TRUE(result.finite) << c.name;
            EXPECT_LE(result.most, 3.3) << c.name;
            EXPECT_EQ(result.faults, 0)
                << c.name << (coupled ? " coupled " : " ") << speed << " m/s at " << 1e3 * z
                << " mm " << (form == ForceForm::literal);
          }
      }
}

// Off the relief and within the shell about it, the last contact is forgotten: the coupling acts on
// the depth, and its damper on the tip.
TEST(PaintedRelief, CouplingRestartsAfterTheShell) {
  Scene scene = sceneOf(500);
  scene.stabilisers = Stabilisers{true, false};
  const HapticObject object = reliefOf(64, 4e-3, [](double u, double) { return u > 0.8 ? 1 : 0; });
  const auto snapshot = compiledWith(scene, object, fineSlab().field);
  ContactMemory memory;
  glide(*snapshot, memory, Vec3(0, 0, 6e-3));
  glide(*snapshot, memory, Vec3(0, 0, -1e-3));
  EXPECT_FALSE(glide(*snapshot, memory, Vec3(0, 0, 1e-3)).touching);
  const Contact again = tick(*snapshot, memory, Vec3(0, 0, -1e-4), 1e-3);
  const double speed = 1.1; // [m/s]
  EXPECT_NEAR(again.force.z(),
              again.stiffness * 1e-4 + snapshot->stabilisers.coupling->damping * speed, 1e-6);
}

// A jump of the tip is a fault also over relief.
TEST(PaintedRelief, TeleportIsStillAFault) {
  Scene scene = sceneOf(500);
  const HapticObject object =
      reliefOf(256, 0.2e-3, [](double u, double) { return std::cos(100 * u); });
  const auto snapshot = compiledWith(scene, object, fineSlab().field);
  ContactMemory memory;
  glide(*snapshot, memory, Vec3(0, 0, -0.5e-3));
  EXPECT_TRUE(tick(*snapshot, memory, Vec3(1e-4, 0, -6.5e-3), 1e-3).fault);
}

// F7: texture adds P |h''| of lateral stiffness; the map includes it, and the loop buzzes at the
// predicted limit.
TEST(PaintedRelief, MapPredictsTheBuzzOfTexture) {
  const double wavelength = 1.5e-3, K = 300, P = 0.5;
  const double k = 2 * std::numbers::pi / wavelength;
  const double limit = stiffnessLimit(sampledLoop(DeviceModel{}));
  for (const double share : {0.5, 2.0}) {
    const double A = share * limit / (P * k * k);
    const HapticObject object = hapticRelief(
        fineSlab().faces,
        reliefImage(1024, [&](double u, double) { return -std::cos(k * Slab::kSide * (u - 0.5)); }),
        A);
    Scene scene = sceneOf(K);
    const std::span<const HapticObject> objects(&object, 1);
    const StiffnessProbe probe(scene, fineSlab().field, objects);
    const auto at = probe.at(Vec3(0, 1e-4, 0), P / K);
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->lambda_max / (P * A * k * k), 1, 0.03) << share;
    const double ratio = stabilityRatio(*at, scene, loopLimits(scene, objects));
    EXPECT_NEAR(ratio, 1 / share, 0.05 / share);
    SimulationSpec spec;
    spec.surface = Vec3(1e-6, 1e-4, -A);
    spec.depth = P / K;
    spec.press = P;
    spec.seconds = 12;
    Progress progress;
    const auto run = simulate(*compiledWith(scene, object, fineSlab().field), spec, progress);
    EXPECT_EQ(run.stable, share < 1) << share << " " << run.rms_velocity;
  }
}

// Roughness has the painted rms height, the same in the conservative form.
TEST(PaintedRoughness, HasThePaintedRmsHeight) {
  const double rms = 0.1e-3, K = 500;
  Scene scene = sceneOf(K);
  const HapticObject object =
      hapticMaterial(*coveredMap(kVoxel, cube(12e-3), MaterialChannel::roughness,
                                 [=](const Vec3&) { return rms; }),
                     scene);
  const auto snapshot = compiledWith(scene, object, planeField(kVoxel));
  double sum = 0, square = 0;
  const int count = 200;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const Vec3 tip(10e-3 * (i / 100.0 - 1), 10e-3 * (j / 100.0 - 1), -1e-3);
      const double h = touchOnce(*snapshot, tip).force.z() / K - 1e-3;
      sum += h;
      square += h * h;
    }
  const double n = count * count, mean = sum / n;
  std::printf("roughness: rms %.4f of what was painted\n",
              std::sqrt(square / n - mean * mean) / rms);
  EXPECT_NEAR(std::sqrt(square / n - mean * mean), rms, 0.05 * rms);
  EXPECT_NEAR(mean, 0, 0.05 * rms);
}

TEST(PaintedRoughness, DoesNoWorkRoundALoopAlsoAtItsEdge) {
  Scene scene = sceneOf(500);
  const HapticObject object =
      hapticMaterial(*coveredMap(kVoxel, cube(12e-3), MaterialChannel::roughness,
                                 [](const Vec3& p) { return p.x() > 0 ? 0.1e-3 : 0; }),
                     scene);
  double work[2];
  for (const ForceForm form : {ForceForm::literal, ForceForm::conservative}) {
    scene.relief.form = form;
    const auto snapshot = compiledWith(scene, object, planeField(kVoxel));
    const std::vector<Vec3> corners{Vec3(3.1e-3, 2e-3, -2e-3), Vec3(3.1e-3, 2e-3, -1e-3),
                                    Vec3(-1e-3, 1e-4, -1e-3), Vec3(-1e-3, 1e-4, -2e-3)};
    const double sum = loopWork(*snapshot, corners, 5000);
    work[form == ForceForm::conservative] = sum;
  }
  std::printf("roughness: literal %.3g J, conservative %.3g J a loop\n", work[0], work[1]);
  EXPECT_GT(std::abs(work[0]), 1e-6);
  EXPECT_LT(std::abs(work[1]), 5e-3 * std::abs(work[0]));
}

} // namespace
} // namespace patina
