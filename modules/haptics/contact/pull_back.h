// Pulls a surface gradient back to the tip by the Jacobian of the closest point (F6).
#pragma once

#include "field/sampling/field_sampler.h"
#include "haptics/contact/contact.h"

namespace patina {

// Evaluates J at the surface point q (grid coordinates). n: unit outward normal there; phi: signed
// distance of the tip [voxel], positive outside.
SurfaceJacobian closestPointJacobian(const FieldSampler& sampler, const Vec3& q, const Vec3& n,
                                     double phi) noexcept;

SurfaceJacobian jacobianOf(const FieldSampler& sampler, const Contact& contact) noexcept;

// Returns J times `along` at contact.surface. J is the derivative of the contact point with respect
// to the tip: two active walls let that point move only along their common line, three not at all.
// This also holds where ActiveConstraints merges two walls, because the contact point stays on
// their line. Computes J once per tick and stores it in the contact.
inline Vec3 pulledBack(const FieldSampler& sampler, Contact& contact, const Vec3& along) noexcept {
  if (!contact.jacobian) contact.jacobian = jacobianOf(sampler, contact);
  return *contact.jacobian * along;
}

} // namespace patina
