// Versions of a field that differ in some blocks (copy-on-write).
#pragma once

#include <cstdint>
#include <span>

#include "field/store/surface_field.h"

namespace patina {

// `field` is a copy of a field with samples in which the distance blocks of the `changed` slots
// were replaced. Renews the samples that are made from them, their own and those of the blocks
// about, so that all are bit for bit those of withSamples(). Where none of the distance blocks that
// a sample block is made from differs from `original`'s, its sample block is shared. `original` has
// the same slots, and samples. Parallel.
void renewSamples(SurfaceField& field, std::span<const std::int32_t> changed,
                  const SurfaceField& original);

} // namespace patina
