#include "haptics/stages/material_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/mesh/joint_mesh.h"
#include "haptics/contact/contact_memory.h"
#include "haptics/contact/pull_back.h"

namespace patina {

std::int32_t OwnerStage::ownerAt(const Vec3& p) const noexcept {
  return std::max(partOfFace(objects_, sampler_.faceNear(p), &FeltObject::first_face), 0);
}

void OwnerStage::apply(Contact& contact, ContactMemory&) const noexcept {
  if (contact.touching) contact.object = ownerAt(contact.surface);
}

MaterialStage::MaterialStage(std::span<const FeltObject> objects, bool gradients)
    : gradients_(gradients) {
  readers_.reserve(objects.size());
  for (const FeltObject& object : objects) {
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
  const TextureShare at = reliefs_->at(contact.object, contact.surface, memory.walk).texture;
  if (!at.of || !(at.of->stiffness > 0)) return;
  const double more = at.of->stiffness - contact.material.stiffness;
  if (Vec3& gradient = contact.gradients.stiffness; gradients_)
    gradient = (1 - at.share) * gradient + more * at.slope;
  contact.material.stiffness += at.share * more;
}

void StiffnessSlopeStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const double last = std::exchange(memory.stiffness_slope.force, 0);
  if (contact.touching && contact.material.stiffness > 0 &&
      !contact.gradients.stiffness.isZero(0)) {
    // d of the potential: along the surface's own normal, not the slope of its relief.
    const double square = contact.depth * contact.depth / (1 + contact.slope.squaredNorm());
    const double softened = contact.stiffness == contact.material.stiffness
                                ? 1
                                : contact.stiffness / contact.material.stiffness;
    const Vec3 force = -0.5 * square * softened * softened *
                       pulledBack(sampler_, contact, contact.gradients.stiffness);
    contact.force += force;
    memory.stiffness_slope.force = force.norm();
  }
  // It comes and goes with the cells of the map, which is no jump.
  contact.known_step += last + memory.stiffness_slope.force;
}

} // namespace patina
