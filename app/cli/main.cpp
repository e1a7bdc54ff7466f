#include <csignal>
#include <malloc.h>
#include <optional>

#include <tbb/global_control.h>
#include <vtkObject.h>

#include "app/cli/command_line.h"
#include "core/memory_left.h"

int main(int argc, char** argv) {
  using namespace patina;
  // VTK's faults become one Error; this suppresses its additional output.
  vtkObject::GlobalWarningDisplayOff();
  std::signal(SIGXFSZ, SIG_IGN); // a limit on file size becomes a disk error (EFBIG)
  // Each thread takes 8 MB of stack and 64 MB of heap from the memory limit; libraries abort if a
  // thread cannot start.
  std::optional<tbb::global_control> alone;
  if (memoryIsLimited()) {
    ::mallopt(M_ARENA_MAX, 1);
    alone.emplace(tbb::global_control::max_allowed_parallelism, 1);
  }
  return cli::runCommandLine(argc, argv);
}
