// A mass on a texture that is stiffer along the surface than the loop can render (F7): the lateral
// coupling calms it.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "authoring/relief/relief_limits.h"
#include "haptics/law/coupling_stage.h"
#include "stability/texture_support.h"

namespace patina {
namespace {

// The loop needs the coupling on these textures.
TEST(TextureLoop, BuzzesOrLeavesWithoutTheLateralCoupling) {
  for (const Texture& texture : stiffTextures())
    for (const double stiffness : kStiffnesses) {
      const Scene scene = bare(stiffness);
      EXPECT_GT(felt(texture, scene, comesDown(scene)).rms_velocity, 0.01)
          << texture.name << " " << stiffness;
    }
}

TEST(TextureLoop, RestsAtAnyStiffnessAloneInAHandAndWithJitter) {
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

// Textures that are gentle under a light press count too: at 9.8 um rms, 500 N/m along the surface
// at 1 N.
TEST(TextureLoop, RestsUnderTheServosMaxForce) {
  const double press = 3.2, limit = 3.3;
  for (const double rms : {2e-6, 2.9e-6, 3.1e-6, 9.8e-6, 50e-6})
    for (const double stiffness : kStiffnesses) {
      Scene scene = automatic(stiffness);
      scene.haptics.force_limit = limit;
      const HapticObject object = rough(rms, scene);
      const auto snapshot = compileStages(scene, planeField(kVoxel, 96), std::span(&object, 1));
      SimulationSpec spec = comesDown(scene);
      spec.press = press;
      Progress progress;
      const SimulationReport run = simulate(*snapshot, spec, progress);
      EXPECT_LE(run.rms_velocity, 1e-6) << rms << " " << stiffness;
      EXPECT_TRUE(run.touches_late) << rms << " " << stiffness;
      EXPECT_EQ(run.fault_ticks, 0u) << rms << " " << stiffness;
    }
}

// A groove in the image, pressed at its bottom, where the slope is zero, and steep on both sides:
// just too gentle for the coupling, just steep enough, and steeper.
TEST(TextureLoop, RestsInAGrooveOfTheImage) {
  const double high = 0.3e-3, limit = 3.3, texel = Slab::kSide / 1024;
  const auto uvs = std::make_shared<const CornerUvs>(uvsFromAbove(*fineSlab().mesh, Slab::kSide));
  const CurvatureMap bends(fineSlab().mesh, uvs, 1024, 1024);
  const double gentle = texel * maxStableCurvature(limit, DeviceModel{});
  for (const double slope : {0.95 * gentle, 1.05 * gentle, 0.2, 1.0, 3.0}) {
    const auto image = reliefImage(1024, [=](double u, double) {
      return std::min(1.0, std::abs(Slab::kSide * (u - 0.5)) * slope / high);
    });
    HapticObject object = hapticRelief(fineSlab().faces, image, high, kReliefOvershoot);
    const std::vector<float> bend = bends.perTile(*image);
    object.max_curvature = high * static_cast<double>(*std::max_element(bend.begin(), bend.end()));
    EXPECT_NEAR(object.max_curvature, slope / texel, 1e-3 * slope / texel); // between two texels
    for (const double stiffness : {300.0, 490.0, 700.0, 1000.0, 2000.0})
      for (const double aside : {0.0, 20e-6, 0.1e-3}) {
        Scene scene = automatic(stiffness);
        scene.haptics.force_limit = limit;
        SimulationSpec spec = comesDown(scene);
        spec.surface.x() = aside;
        spec.press = 3;
        spec.seconds = 12;
        const auto snapshot = compileStages(scene, fineSlab().field, std::span(&object, 1));
        EXPECT_EQ(hasLateral(*snapshot), slope > gentle);
        Progress progress;
        const SimulationReport run = simulate(*snapshot, spec, progress);
        EXPECT_LE(run.rms_velocity, 1e-6) << slope << " " << stiffness << " " << aside;
        EXPECT_TRUE(run.touches_late) << slope << " " << stiffness << " " << aside;
        EXPECT_EQ(run.fault_ticks, 0u) << slope << " " << stiffness << " " << aside;
      }
  }
}

// k_l and B are planned from the device: heavy and light, with short and long delay.
TEST(TextureLoop, CalmsDownOnAnyDampedDevice) {
  Progress progress;
  for (const double mass : {0.02, 0.1, 0.5})
    for (const double damping : {0.1, 0.5, 5.0})
      for (const double rate : {500.0, 1000.0, 4000.0})
        for (const int delay : {0, 2, 5})
          for (const double amplitude : {50e-6, 200e-6}) {
            Scene scene = automatic(1000);
            scene.device_model = DeviceModel{mass, damping, 0, 0, rate, delay};
            const HapticObject object = waves(amplitude, true);
            const auto snapshot = compileStages(scene, fineSlab().field, std::span(&object, 1));
            SimulationSpec spec = comesDown(scene);
            spec.press = 0.5;
            spec.seconds = 12;
            const SimulationReport run = simulate(*snapshot, spec, progress);
            const std::string what = "m " + std::to_string(mass) + " b " + std::to_string(damping) +
                                     " rate " + std::to_string(rate) + " n " +
                                     std::to_string(delay);
            EXPECT_TRUE(run.verdict == Verdict::kAtRest || run.verdict == Verdict::kDecaying)
                << what << ": " << run.rms_velocity << ", early " << run.rms_early;
            EXPECT_EQ(run.fault_ticks, 0u) << what;
          }
}

// An encoder alone lets nothing stiff rest: between two of its steps there is no force, and the
// tip wanders from one to the other, on a plane too. This is its quietest state.
TEST(TextureLoop, StaysWithinThreeStepsWithAnEncoderAndJitter) {
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

// 2.2: the device's dry friction locks it.
TEST(TextureLoop, RestsWithAnEncoderAndDryFriction) {
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

// On curved surfaces: in a bowl, and on a ball, where a hand must keep the tip.
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
      const HapticObject object = rough(50e-6, scene);
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

} // namespace
} // namespace patina
