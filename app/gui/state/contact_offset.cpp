#include "app/gui/state/contact_offset.h"

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
  const double offset = contactOffset(scene.scene.haptics),
               raised = reliefOver(scene.snapshot->objects),
               clear = 0.5 * scene.built.field->grid.voxel;
  ContactMemory memory;
  const auto at = [&](double above) {
    return tick(*scene.snapshot, memory, surface + above * normal, 1e-3);
  };
  // Approaches from outside like a hand; then goes below the lowest groove.
  at(offset + raised + clear);
  const Contact contact = at(offset - clampedDepth(scene, surface, raised + clear));
  if (!(contact.stiffness > 0)) return newtons / scene.scene.haptics.stiffness;
  // |F|² = (K d)² + (d² |∇K| / 2)², the second part tangential. In series with a coupling K = k c /
  // (k + c) and ∇K = (K / k)² ∇k.
  const double stiffness_ratio = contact.stiffness / contact.material.stiffness;
  const Vec3 gradient = stiffness_ratio * stiffness_ratio * contact.gradients.stiffness;
  const double square = contact.stiffness * contact.stiffness,
               across = newtons * (gradient - gradient.dot(normal) * normal).norm();
  return newtons * std::sqrt(2 / (square + std::hypot(square, across)));
}

double contactOffset(const HapticProperties& haptics) {
  return haptics.tip_radius.value_or(0) + haptics.offset.value_or(0);
}

double clampedDepth(const CompiledScene& scene, const Vec3& surface, double depth) {
  const FieldSampler sampler(*scene.built.field, scene.scene.sampler);
  const Vec3 inwards = -normalAt(scene, surface);
  const double step = 0.5 * scene.built.field->grid.voxel;
  double at = 0, phi = 0;
  while (at < 2 * depth) {
    const double next = at + std::max(step, -phi),
                 beyond = sampler.at(surface + next * inwards).phi;
    if (beyond >= 0) // The opposite side is crossed in this step.
      return std::min(depth, 0.5 * (at - phi / (beyond - phi) * (next - at)));
    at = next;
    phi = beyond;
  }
  return depth;
}

Vec3 tipAtContact(const CompiledScene& scene, const Vec3& surface) {
  return surface + contactOffset(scene.scene.haptics) * normalAt(scene, surface);
}

} // namespace patina
