#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include <vtkObject.h>

#include "app/cli/command_line.h"
#include "app/cli/commands/command.h"
#include "core/error.h"

namespace {

int fail(int code, std::string message) {
  for (char& c : message)
    if (c == '\n') c = ' ';
  std::fprintf(stderr, "patina: %s\n", message.c_str());
  return code;
}

} // namespace

int main(int argc, char** argv) {
  using namespace patina;
  // What goes wrong inside VTK reaches the user as one Error; its own chatter would be more lines.
  vtkObject::GlobalWarningDisplayOff();
  try {
    const int code = cli::runCommandLine(argc, argv);
    // A full disk behind a redirected report must not look like success.
    return std::fflush(stdout) == 0 ? code
                                    : fail(cli::kBadInput, "standard output cannot be written");
  } catch (const Cancelled& cancelled) {
    return fail(cli::kCancelledByUser, cancelled.what());
  } catch (const std::bad_alloc&) {
    return fail(cli::kBadInput, "not enough memory");
  } catch (const std::exception& error) {
    return fail(cli::kBadInput, error.what());
  }
}
