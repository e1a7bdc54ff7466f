// The words a person typed, turned into one command's run.
#pragma once

namespace patina::cli {

// What goes wrong is one line on stderr. Returns the exit code.
int runCommandLine(int argc, char** argv);

} // namespace patina::cli
