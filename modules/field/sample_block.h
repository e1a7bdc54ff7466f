// Making what the servo reads of one block: private to the field.
#pragma once

#include <cstddef>
#include <memory>

#include "field/surface_field.h"

namespace patina {

// From the distances of the block and the 26 about it.
std::shared_ptr<const SampleBlock> sampleBlock(const SurfaceField& field, std::size_t slot);

} // namespace patina
