// Updates copies of a field in which some blocks differ (copy-on-write).
#pragma once

#include <cstdint>
#include <span>

#include "field/store/surface_field.h"

namespace patina {

// `field` is a copy of a field with samples in which the distance blocks of the `changed` slots
// were replaced. Recomputes their samples and those of the neighbouring blocks, so that all equal
// those of withSamples() bit for bit. A sample block is shared with `original` if no distance block
// that it is made from differs. `original` has samples and the same slots. Parallel.
void updateSamples(SurfaceField& field, std::span<const std::int32_t> changed,
                   const SurfaceField& original);

} // namespace patina
