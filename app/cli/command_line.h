// The words a person typed, turned into one command's run.
#pragma once

namespace patina::cli {

// Prints help and versions itself. Throws Error (one line) for a wrong word and whatever the
// command throws. Returns the exit code.
int runCommandLine(int argc, char** argv);

} // namespace patina::cli
