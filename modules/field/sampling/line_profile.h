// Distance along a straight line through a field.
#pragma once

#include <cstddef>
#include <vector>

#include "field/sampling/field_sampler.h"

namespace patina {

struct LineSample {
  double along = 0; // distance from the line's start [m]
  Vec3 point = Vec3::Zero();
  double phi = 0; // [m], negative inside; NaN beyond the band
};

// Returns `count` >= 2 samples from one end to the other, at equal distances. Throws Error if the
// ends coincide or are not finite.
std::vector<LineSample> profileAlong(const FieldSampler& sampler, const Vec3& from, const Vec3& to,
                                     std::size_t count);

} // namespace patina
