// What each stage of a compiled scene costs on this machine.
#pragma once

#include <vector>

#include "session/build/session.h"

namespace patina {

// What reading the clock once adds to a measured time [ns].
double timerNs();

// Median time of each stage [ns], in the snapshot's order, the clock's own left out: strokes of a
// tip pressed into the mesh at evenly chosen faces. Takes some milliseconds.
std::vector<double> stageNs(const CompiledScene& compiled);

} // namespace patina
