// How something that lies on the surface changes as the tip moves: J^T of the closest point (K12).
#pragma once

#include "field/sampling/field_sampler.h"
#include "haptics/contact/contact.h"

namespace patina {

// `along`: the gradient over the surface of a quantity that is read at the point s closest to the
// tip; the result is its gradient by the tip, J^T along with J = (I + phi H)^-1 (I - n n^T), H the
// curvature of the surface at s, where tip = s + phi n. q: s in grid coordinates; n: unit, outward
// there; phi [voxel]. The curvature is the difference of the sampler's directions a voxel apart:
// O(h^2) of itself. Towards a medial axis J grows beyond bounds; it is held at 4.
Vec3 pulledBack(const FieldSampler& sampler, const Vec3& q, const Vec3& n, double phi,
                const Vec3& along) noexcept;

// The same at contact.surface for a contact held by one wall. Two leave J only the line they have
// in common, three nothing; also where Hold takes two for one, because the contact point stays on
// their line all the same.
Vec3 pulledBack(const FieldSampler& sampler, const Contact& contact, const Vec3& along) noexcept;

} // namespace patina
