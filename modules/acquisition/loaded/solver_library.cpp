#include "acquisition/loaded/solver_library.h"

#include <cstdlib>

#include "core/error.h"
#include "core/loaded_library.h"
#include "core/memory_left.h"

namespace patina {

const SolverLibrary& solverLibrary() {
  static std::string solver_cause;
  static void* const solver_symbol = [] {
    requireRoomToLoad("the library of the joint fit");
    // OpenBLAS reads this while it is loaded: no threads of its own, which disturb the servo.
    ::setenv("OPENBLAS_NUM_THREADS", "1", 0);
    return loadedSymbol("patina_solver.so", kSolverLibrarySymbol, solver_cause);
  }();
  if (!solver_symbol)
    throw Error("a joint fit needs Patina's library of solvers, which cannot be loaded: " +
                solver_cause);
  return *reinterpret_cast<SolverLibraryFunction*>(solver_symbol)();
}

} // namespace patina
