// What keeps the tip from passing through parts thinner than its step (K03), in grid coordinates.
#pragma once

#include <optional>

#include "field/field_sampler.h"

namespace patina {

// A point of the surface phi = iso and the outward unit normal there.
struct SurfaceContact {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
};

// Where the segment from -> to first enters phi < iso, if it does; `from` is outside. Steps of
// phi - iso, but 1/16 voxel at least (what is thinner may be missed); gives up after 128.
std::optional<SurfaceContact> firstCrossing(const FieldSampler& sampler, const Vec3& from,
                                            const Vec3& to, double iso) noexcept;

// Walks `start` over the surface until the tip q lies on its normal: the VCP of an ideal proxy
// (up to 8 steps of at most a voxel, `reach` voxels together; what is left is walked next time).
// nullopt if the surface is lost: no direction, or not in the band.
std::optional<SurfaceContact> trackFoot(const FieldSampler& sampler, const Vec3& q,
                                        SurfaceContact start, double iso, double reach) noexcept;

// Walks `start` over the surface to where it is nearest to the tip q, downhill only, in up to 12
// steps of at most a voxel, so that it comes to rest in a crease. nullopt if the surface is not
// there.
std::optional<Vec3> descendToNearest(const FieldSampler& sampler, const Vec3& q, const Vec3& start,
                                     double iso) noexcept;

} // namespace patina
