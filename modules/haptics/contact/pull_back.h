// How something that lies on the surface changes as the tip moves: by J of the closest point (F6).
#pragma once

#include "field/sampling/field_sampler.h"
#include "haptics/contact/contact.h"

namespace patina {

// J by a look at the surface itself, at q in grid coordinates; n: unit, outward there; phi [voxel]:
// of the tip, positive outside.
SurfaceJacobian closestPointJacobian(const FieldSampler& sampler, const Vec3& q, const Vec3& n,
                                     double phi) noexcept;

SurfaceJacobian jacobianOf(const FieldSampler& sampler, const Contact& contact) noexcept;

// J along, at contact.surface for a contact held by one wall. Two leave J only the line they have
// in common, three nothing; also where WallHold takes two for one, because the contact point stays
// on their line all the same. J is worked out once a tick and kept in the contact.
inline Vec3 pulledBack(const FieldSampler& sampler, Contact& contact, const Vec3& along) noexcept {
  if (!contact.jacobian) contact.jacobian = jacobianOf(sampler, contact);
  return *contact.jacobian * along;
}

} // namespace patina
