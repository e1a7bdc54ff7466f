// The library with Ceres, loaded on first use.
#pragma once

#include "acquisition/loaded/solver.h"

namespace patina {

// Throws Error with the missing file and the places searched.
const SolverLibrary& solverLibrary();

} // namespace patina
