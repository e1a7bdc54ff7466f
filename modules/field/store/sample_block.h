// Computes the samples of one block for the servo. Internal to the field.
#pragma once

#include <cstddef>
#include <memory>

#include "field/store/node_reader.h"

namespace patina {

// Uses the distances of the block and its 26 neighbours.
std::shared_ptr<const SampleBlock> sampleBlock(const NodeReader& nodes, std::size_t slot);

} // namespace patina
