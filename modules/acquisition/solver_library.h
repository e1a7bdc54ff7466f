// The library that holds Ceres, loaded when it is first asked for.
#pragma once

#include "acquisition/solver/solver.h"

namespace patina {

// Throws Error saying what is missing and where it was looked for.
const SolverLibrary& solverLibrary();

} // namespace patina
