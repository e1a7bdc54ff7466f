// Parses the command line and runs one command.
#pragma once

namespace patina::cli {

// Prints errors as one line on stderr. Returns the exit code.
int runCommandLine(int argc, char** argv);

} // namespace patina::cli
