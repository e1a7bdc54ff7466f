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

void MaterialStage::apply(Contact& contact, ContactMemory&) const noexcept {
  const auto i = static_cast<std::size_t>(contact.object);
  if (!contact.touching || i >= objects_.size() || !objects_[i].material) return;
  const FeltObject& object = objects_[i];
  MaterialGradients at;
  readMaterial(*object.material, object.object_from_world * contact.surface, contact.material, at);
  const auto inWorld = [&](const Vec3& gradient) {
    return Vec3(object.object_from_world.linear().transpose() * gradient);
  };
  if (!at.roughness.isZero(0)) contact.roughness_gradient = inWorld(at.roughness);
  if (gradients_ && !at.stiffness.isZero(0))
    contact.stiffness_gradient = pulledBack(sampler_, contact, inWorld(at.stiffness));
}

void TextureStiffnessStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  if (!contact.touching || contact.normal.isZero(0)) return;
  const TextureShare at = reliefs_->at(contact.object, contact.surface, memory.walk).texture;
  if (!at.of || !(at.of->stiffness > 0)) return;
  const double more = at.of->stiffness - contact.material.stiffness;
  if (gradients_ && !at.slope.isZero(0))
    contact.stiffness_gradient = (1 - at.share) * contact.stiffness_gradient +
                                 more * pulledBack(reliefs_->sampler(), contact, at.slope);
  else
    contact.stiffness_gradient *= 1 - at.share;
  contact.material.stiffness += at.share * more;
}

void StiffnessSlopeStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const double last = std::exchange(memory.stiffness_slope.force, 0);
  if (contact.touching && contact.material.stiffness > 0) {
    // d of the potential: along the surface's own normal, not the slope of its relief.
    const double square = contact.depth * contact.depth / (1 + contact.slope.squaredNorm());
    const double softened = contact.stiffness == contact.material.stiffness
                                ? 1
                                : contact.stiffness / contact.material.stiffness;
    const Vec3 force = -0.5 * square * softened * softened * contact.stiffness_gradient;
    contact.force += force;
    memory.stiffness_slope.force = force.norm();
  }
  // It comes and goes with the cells of the map, which is no jump.
  contact.known_step += last + memory.stiffness_slope.force;
}

} // namespace patina
