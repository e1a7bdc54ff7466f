// A small ball for painting, and comparisons of scenes and forces.
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "geometry/mesh/shapes.h"
#include "scene/edit.h"
#include "session/compile/compile_scene.h"
#include "support/same_scene.h"

namespace patina::test {

inline constexpr double kBall = 0.03; // [m], radius

inline Scene ballScene() {
  Scene scene;
  SceneObject& object = scene.objects.emplace_back();
  object.name = "ball";
  object.mesh = std::make_shared<const TriangleMesh>(icosphere(kBall, 12));
  scene.field.resolution = 60;
  scene.paint_size = 256;
  return scene;
}

inline Stroke dabAt(Tool tool, double value, double radius, const Vec3& at) {
  Stroke stroke;
  stroke.brush.tool = tool;
  stroke.brush.value = value;
  stroke.brush.radius = radius;
  stroke.brush.falloff = 3;
  stroke.samples.push_back({0, at, 0.5});
  return stroke;
}

// Strokes of every tool and mode at random positions.
inline std::vector<Stroke> manyStrokes(int count, unsigned seed = 7) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const std::pair<Tool, double> tools[] = {{Tool::relief, 4e-4},
                                           {Tool::material(MaterialChannel::stiffness), 900},
                                           {Tool::color, 0},
                                           {Tool::material(MaterialChannel::dynamic_friction), 0.3},
                                           {Tool::material(MaterialChannel::static_friction), 0.5},
                                           {Tool::material(MaterialChannel::damping), 1},
                                           {Tool::material(MaterialChannel::roughness), 2e-5},
                                           {Tool::erase, 0}};
  const StrokeMode modes[] = {StrokeMode::max, StrokeMode::build_up, StrokeMode::smooth};
  std::vector<Stroke> strokes;
  for (int i = 0; i < count; ++i) {
    const auto& [tool, value] = tools[static_cast<std::size_t>(i) % 8];
    const Vec3 from = kBall * Vec3(normal(random), normal(random), normal(random)).normalized();
    Stroke one = dabAt(tool, value, 0.006 + 0.002 * (i % 3), from);
    one.brush.mode = modes[static_cast<std::size_t>(i / 8) % 3];
    const Vec3 step = 0.004 * Vec3(normal(random), normal(random), normal(random)).normalized();
    for (int k = 1; k < 4; ++k)
      one.samples.push_back({0.02 * k, kBall * (from + k * step).normalized(), 0.5});
    strokes.push_back(one);
  }
  return strokes;
}

// Compares forces on a random path of the tip bit for bit.
inline bool feelAlike(const HapticSnapshot& a, const HapticSnapshot& b) {
  ContactMemory left, right;
  Vec3 tip(0, 0, kBall + 1e-3);
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1e-4);
  bool touched = false;
  for (int i = 0; i < 4000; ++i) {
    tip += Vec3(normal(random), normal(random), normal(random));
    tip *= (kBall - 5e-4) / tip.norm();
    const Contact one = tick(a, left, tip, 1e-3), other = tick(b, right, tip, 1e-3);
    if (one.force != other.force) return false;
    touched = touched || one.force.norm() > 0;
  }
  return touched;
}

} // namespace patina::test
