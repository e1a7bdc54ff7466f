#include <csignal>
#include <cstdio>

#include <vtkObject.h>

#include "app/cli/command_line.h"
#include "app/cli/commands/command.h"

int main(int argc, char** argv) {
  using namespace patina;
  // What goes wrong inside VTK reaches the user as one Error; its own chatter would be more lines.
  vtkObject::GlobalWarningDisplayOff();
  std::signal(SIGXFSZ, SIG_IGN); // a limit on a file's size is an error of the disk (EFBIG)
  const int code = cli::runCommandLine(argc, argv);
  // A full disk behind a redirected report must not look like success.
  if (std::fflush(stdout) == 0) return code;
  std::fputs("patina: standard output cannot be written\n", stderr);
  return cli::kBadInput;
}
