// Textures that are stiffer along the surface than the default loop can render, and a mass on them.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "haptics/painted_fixture.h"
#include "haptics/simulation/simulation.h"

namespace patina {

inline constexpr double kWave = 1e-3;                           // [m]
inline constexpr double kNumber = 2 * std::numbers::pi / kWave; // [1/m]
inline constexpr double kVoxel = 0x1p-11;

// The height has its maximum at the middle of the slab; `amplitude` (1 - cos).
inline HapticObject waves(double amplitude, bool crossed = false) {
  static const auto along = reliefImage(
      1024, [](double u, double) { return std::cos(kNumber * Slab::kSide * (u - 0.5)); });
  static const auto both = reliefImage(1024, [](double u, double v) {
    return 0.5 * (std::cos(kNumber * Slab::kSide * (u - 0.5)) +
                  std::cos(kNumber * Slab::kSide * (v - 0.5)));
  });
  HapticObject object = hapticRelief(fineSlab().faces, crossed ? both : along, amplitude);
  object.max_curvature = amplitude * kNumber * kNumber;
  return object;
}

inline HapticObject rough(double rms, const Scene& scene) {
  return hapticMaterial(*coveredMap(kVoxel, cube(12e-3), MaterialChannel::roughness,
                                    [=](const Vec3&) { return rms; }),
                        scene);
}

inline Scene automatic(double stiffness) {
  Scene scene = sceneOf(stiffness);
  scene.device_model = DeviceModel{};
  return scene;
}

inline Scene bare(double stiffness) {
  Scene scene = automatic(stiffness);
  scene.stabilisers = Stabilisers{};
  return scene;
}

struct Texture {
  const char* name;
  std::function<HapticObject(const Scene&)> on;
  Field field;
};
inline std::vector<Texture> stiffTextures() {
  const Field slab = fineSlab().field;
  return {{"50 um", [](const Scene&) { return waves(50e-6); }, slab},
          {"100 um", [](const Scene&) { return waves(100e-6); }, slab},
          {"100 um, crossed", [](const Scene&) { return waves(100e-6, true); }, slab},
          {"roughness 50 um", [](const Scene& scene) { return rough(50e-6, scene); },
           planeField(kVoxel, 96)}};
}
inline constexpr double kStiffnesses[] = {200, 500, 1000, 2000};

inline std::shared_ptr<const HapticSnapshot> compiledOn(const Texture& texture,
                                                        const Scene& scene) {
  const HapticObject object = texture.on(scene);
  return compileStages(scene, texture.field, std::span(&object, 1));
}

inline bool hasLateral(const HapticSnapshot& snapshot) {
  return std::any_of(snapshot.why.begin(), snapshot.why.end(),
                     [](const StageInfo& stage) { return stage.name == "lateral coupling"; });
}

// A mass under 1 N that starts off every line of symmetry.
inline SimulationSpec comesDown(const Scene& scene) {
  SimulationSpec spec;
  spec.device = *scene.device_model;
  spec.surface = Vec3(0.2e-3, 0.13e-3, 0.2e-3);
  spec.press = 1;
  spec.speed = 0.05;
  spec.seconds = 24;
  return spec;
}

inline SimulationReport felt(const Texture& texture, const Scene& scene, const SimulationSpec& spec,
                             const RowSink& row = {}) {
  Progress progress;
  return simulate(*compiledOn(texture, scene), spec, progress, row);
}

} // namespace patina
