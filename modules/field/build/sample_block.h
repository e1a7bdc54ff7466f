// Making what the servo reads of one block: private to the field.
#pragma once

#include <cstddef>
#include <memory>

#include "field/store/node_reader.h"

namespace patina {

// From the distances of the block and the 26 about it.
std::shared_ptr<const SampleBlock> sampleBlock(const NodeReader& nodes, std::size_t slot);

} // namespace patina
