// Measures the run time of each stage of a compiled scene on this machine.
#pragma once

#include <vector>

#include "session/open/session.h"

namespace patina {

// Time added to a measurement by reading the clock once [ns].
double timerNs();

// Median time of each stage [ns], in the snapshot's order, without the clock's own: a tip strokes
// evenly chosen faces. Takes some milliseconds.
std::vector<double> stageNs(const CompiledScene& compiled);

} // namespace patina
