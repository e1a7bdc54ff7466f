#include "app/gui/control/touching.h"

#include <algorithm>
#include <cmath>

#include "field/sampling/field_sampler.h"

namespace patina {

Vec3 normalAt(const CompiledScene& scene, const Vec3& surface) {
  const Vec3 gradient = FieldSampler(*scene.built.field, scene.scene.sampler).at(surface).gradient;
  const double size = gradient.norm();
  return size > 1e-9 ? Vec3(gradient / size) : Vec3::UnitZ();
}

double pressDepth(const CompiledScene& scene, const Vec3& surface, double newtons) {
  const Vec3 normal = normalAt(scene, surface);
  const double skin = skinOf(scene.scene.haptics), raised = raisedBy(scene.snapshot->objects),
               clear = 0.5 * scene.built.field->grid.voxel;
  ContactMemory memory;
  const auto at = [&](double above) {
    return tick(*scene.snapshot, memory, surface + above * normal, 1e-3);
  };
  at(skin + raised + clear); // from outside, as a hand comes; then below the lowest groove
  const Contact contact = at(skin - depthWithin(scene, surface, raised + clear));
  if (!(contact.stiffness > 0)) return newtons / scene.scene.haptics.stiffness;
  // |F|^2 = (K d)^2 + (d^2 |grad K| / 2)^2, the second along the surface. In series with a coupling
  // K = k c / (k + c), and grad K = (K / k)^2 grad k.
  const double softened = contact.stiffness / contact.material.stiffness;
  const Vec3 gradient = softened * softened * contact.gradients.stiffness;
  const double square = contact.stiffness * contact.stiffness,
               across = newtons * (gradient - gradient.dot(normal) * normal).norm();
  return newtons * std::sqrt(2 / (square + std::hypot(square, across)));
}

double skinOf(const HapticProperties& haptics) {
  return haptics.tip_radius.value_or(0) + haptics.offset.value_or(0);
}

double depthWithin(const CompiledScene& scene, const Vec3& surface, double depth) {
  const FieldSampler sampler(*scene.built.field, scene.scene.sampler);
  const Vec3 inwards = -normalAt(scene, surface);
  const double step = 0.5 * scene.built.field->grid.voxel;
  double at = 0, phi = 0;
  while (at < 2 * depth) {
    const double next = at + std::max(step, -phi),
                 beyond = sampler.at(surface + next * inwards).phi;
    if (beyond >= 0) // the other side lies between
      return std::min(depth, 0.5 * (at - phi / (beyond - phi) * (next - at)));
    at = next;
    phi = beyond;
  }
  return depth;
}

Vec3 touching(const CompiledScene& scene, const Vec3& surface) {
  return surface + skinOf(scene.scene.haptics) * normalAt(scene, surface);
}

} // namespace patina
