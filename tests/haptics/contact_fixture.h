// Analytic fields and scenes for the contact tests.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include "haptics/law/snapshot.h"

namespace patina {

using Field = std::shared_ptr<const SurfaceField>;
using Distance = std::function<double(const Vec3&)>;

// A grid of `cells` a side, centred at the origin; the number is even, so that a node lies there.
inline Field cubeField(const Distance& phi, double voxel, int cells, double band = 8) {
  FieldGrid grid;
  grid.voxel = voxel;
  grid.origin = Vec3::Constant(-0.5 * voxel * cells);
  grid.nodes = {cells + 1, cells + 1, cells + 1};
  return withSamples(std::make_shared<SurfaceField>(sampleFunction(phi, grid, band)));
}

inline double sphereDistance(const Vec3& p, double radius) {
  return p.norm() - radius;
}
inline double boxDistance(const Vec3& p, const Vec3& half) {
  const Vec3 q = p.cwiseAbs() - half;
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

// Solid below z = 0.
inline Field planeField(double voxel = 0x1p-11, int cells = 64) {
  return cubeField([](const Vec3& p) { return p.z(); }, voxel, cells);
}
inline Field sphereField(double radius = 0.03, int cells = 150) {
  return cubeField([=](const Vec3& p) { return sphereDistance(p, radius); },
                   2 * radius / (cells - 16), cells);
}
// A plate across z, 0.5 mm thick by default; its rim is inside the grid.
inline Field plateField(double thickness = 0.5e-3, double voxel = 0.1e-3, int cells = 80) {
  const double side = 0.5 * voxel * cells - 12 * voxel;
  return cubeField([=](const Vec3& p) { return boxDistance(p, Vec3(side, side, 0.5 * thickness)); },
                   voxel, cells);
}

inline Scene sceneOf(double stiffness, Sampler sampler = Sampler::high) {
  Scene scene;
  scene.sampler = sampler;
  scene.haptics.stiffness = stiffness;
  scene.haptics.force_limit = 1e3;
  return scene;
}
inline Scene withFriction(Scene scene, double fixed, double sliding, double gain = 0) {
  Friction friction;
  friction.static_coefficient = fixed;
  friction.dynamic_coefficient = sliding;
  friction.depth_gain = gain;
  scene.haptics.friction = friction;
  return scene;
}

// Runs ticks of 1 ms along a straight line at no more than `step` metres each; returns the last
// one's contact.
inline Contact glide(const HapticSnapshot& snapshot, ContactMemory& memory, const Vec3& to,
                     double step = 0.2e-3, double dt = 1e-3) {
  const Vec3 from = memory.tip.last ? *memory.tip.last : to;
  const int count = std::max(1, static_cast<int>(std::ceil((to - from).norm() / step)));
  Contact contact;
  for (int i = 1; i <= count; ++i) {
    contact = tick(snapshot, memory, from + static_cast<double>(i) / count * (to - from), dt);
  }
  return contact;
}

// Runs a single tick without history.
inline Contact touchOnce(const HapticSnapshot& snapshot, const Vec3& tip) {
  ContactMemory memory;
  return tick(snapshot, memory, tip, 1e-3);
}

inline Vec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

} // namespace patina
