// A mass on a texture that is stiffer along the surface than the loop bears (F7): the lateral coupling
// keeps it quiet, and does not touch what needs none.
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "haptics/coupling_stage.h"
#include "haptics/painted_fixture.h"
#include "haptics/simulation.h"
#include "haptics/stability_map.h"

namespace patina {
namespace {

constexpr double kWave = 1e-3;                            // [m]
constexpr double kNumber = 2 * std::numbers::pi / kWave;  // [1/m]
constexpr double kVoxel = 0x1p-11;

// Highest at the middle of the slab; `amplitude` (1 - cos).
FeltObject waves(double amplitude, bool crossed = false) {
  static const auto along = reliefImage(1024, [](double u, double) {
    return std::cos(kNumber * Slab::kSide * (u - 0.5));
  });
  static const auto both = reliefImage(1024, [](double u, double v) {
    return 0.5 * (std::cos(kNumber * Slab::kSide * (u - 0.5)) +
                  std::cos(kNumber * Slab::kSide * (v - 0.5)));
  });
  FeltObject object = feltRelief(fineSlab().faces, crossed ? both : along, amplitude);
  object.bend = amplitude * kNumber * kNumber;
  return object;
}

FeltObject rough(double rms) {
  return feltMaterial(*coveredMap(kVoxel, cube(12e-3), MaterialChannel::roughness,
                                  [=](const Vec3&) { return rms; }),
                      sceneOf(500));
}

Scene automatic(double stiffness) {
  Scene scene = sceneOf(stiffness);
  scene.device_model = DeviceModel{};
  return scene;
}

TEST(TextureLoop, Explore) {
  struct T { const char* name; FeltObject object; Field field; };
  const std::vector<T> all = {{"50", waves(50e-6), fineSlab().field}, {"100", waves(100e-6), fineSlab().field},
    {"50x", waves(50e-6, true), fineSlab().field}, {"100x", waves(100e-6, true), fineSlab().field},
    {"rough50", rough(50e-6), planeField(kVoxel)}};
  for (const T& t : all)
    for (const double K : {200., 500., 1000., 2000.})
      for (const int kind : {0, 1, 2, 3}) {
        Scene scene = automatic(K);
        if (kind == 3) scene.device_model->encoder_step = 20e-6;
        const auto snapshot = compileStages(scene, t.field, std::span(&t.object, 1));
        SimulationSpec spec;
        spec.device = *scene.device_model;
        spec.surface = Vec3(0.2e-3, 0.13e-3, 0.2e-3);
        spec.press = 1;
        spec.speed = 0.05;
        spec.seconds = 16;
        if (kind == 1) spec.hand = HandModel{0.05, 1, 100};
        if (kind >= 2) spec.jitter = PeriodRange{0.5e-3, 2e-3};
        Progress progress;
        const auto run = simulate(*snapshot, spec, progress);
        const auto l = snapshot->stabilisers.lateral.value_or(LateralPlan{});
        std::printf("%7s K %5.0f kind %d: %-12s rms %.2g early %.2g depth %.2f mm force %.2f faults %d  k_l %.0f B %.2f k_c %.0f\n", t.name, K, kind,
                    name(run.verdict), run.rms_velocity, run.rms_early, 1e3 * run.max_depth, run.max_force, (int)run.fault_ticks, l.stiffness, l.damping, l.coupling);
      }
}

} // namespace
} // namespace patina
