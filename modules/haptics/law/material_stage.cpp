#include "haptics/law/material_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/mesh/combined_mesh.h"
#include "haptics/contact/pull_back.h"
#include "haptics/law/contact_memory.h"

namespace patina {

std::int32_t OwnerStage::ownerAt(const Vec3& p) const noexcept {
  return std::max(objectOfFace(objects_, sampler_.faceNear(p), &HapticObject::first_face), 0);
}

void OwnerStage::apply(Contact& contact, ContactMemory&) const noexcept {
  if (contact.touching) contact.object = ownerAt(contact.surface);
}

MaterialStage::MaterialStage(std::span<const HapticObject> objects, bool gradients)
    : gradients_(gradients) {
  readers_.reserve(objects.size());
  for (const HapticObject& object : objects) {
    readers_.emplace_back();
    if (object.material) readers_.back().emplace(*object.material, object.object_from_world);
  }
}

void MaterialStage::apply(Contact& contact, ContactMemory&) const noexcept {
  const auto i = static_cast<std::size_t>(contact.object);
  if (!contact.touching || i >= readers_.size() || !readers_[i]) return;
  readers_[i]->read(contact.surface, contact.material, contact.gradients);
  if (!gradients_) contact.gradients.stiffness.setZero();
}

void TextureStiffnessStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  if (!contact.touching || contact.normal.isZero(0)) return;
  const TextureWeight at = reliefs_->at(contact.object, contact.surface, memory.walk).texture;
  if (!at.texture || !(at.texture->stiffness > 0)) return;
  const double more = at.texture->stiffness - contact.material.stiffness;
  if (Vec3& gradient = contact.gradients.stiffness; gradients_)
    gradient = (1 - at.weight) * gradient + more * at.slope;
  contact.material.stiffness += at.weight * more;
}

void StiffnessGradientStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const double last = std::exchange(memory.stiffness_gradient.force, 0);
  if (contact.touching && contact.material.stiffness > 0 &&
      !contact.gradients.stiffness.isZero(0)) {
    // Depth of the potential: along the normal of the surface without relief.
    const double square = contact.depth * contact.depth / (1 + contact.slope.squaredNorm());
    const double series_factor = contact.stiffness == contact.material.stiffness
                                     ? 1
                                     : contact.stiffness / contact.material.stiffness;
    const Vec3 force = -0.5 * square * series_factor * series_factor *
                       pulledBack(sampler_, contact, contact.gradients.stiffness);
    contact.force += force;
    memory.stiffness_gradient.force = force.norm();
  }
  // The term switches on and off at cell borders of the map, which is no fault.
  contact.expected_force_jump += last + memory.stiffness_gradient.force;
}

} // namespace patina
