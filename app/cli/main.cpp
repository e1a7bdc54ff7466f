#include <csignal>
#include <cstdio>
#include <malloc.h>
#include <optional>

#include <tbb/global_control.h>
#include <vtkObject.h>

#include "app/cli/command_line.h"
#include "app/cli/commands/command.h"
#include "core/memory_left.h"

int main(int argc, char** argv) {
  using namespace patina;
  // What goes wrong inside VTK reaches the user as one Error; its own chatter would be more lines.
  vtkObject::GlobalWarningDisplayOff();
  std::signal(SIGXFSZ, SIG_IGN); // a limit on a file's size is an error of the disk (EFBIG)
  // Each thread takes 8 MB of stack and 64 MB of heap from what a limit leaves; where one cannot be
  // started, libraries abort.
  std::optional<tbb::global_control> alone;
  if (memoryIsLimited()) {
    ::mallopt(M_ARENA_MAX, 1);
    alone.emplace(tbb::global_control::max_allowed_parallelism, 1);
  }
  const int code = cli::runCommandLine(argc, argv);
  // A full disk behind a redirected report must not look like success.
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  std::fputs("patina: standard output cannot be written\n", stderr);
  return cli::kBadInput;
}
