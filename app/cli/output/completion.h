// Scripts by which a shell completes the command line, made from the commands.
#pragma once

#include <string>
#include <vector>

#include "app/cli/commands/command.h"

namespace patina::cli {

// To be sourced, or put where bash-completion looks.
std::string bashCompletion(const std::vector<Command>& commands);
// As _patina in a folder of zsh's fpath.
std::string zshCompletion(const std::vector<Command>& commands);
// As patina.fish in a folder of fish's completions.
std::string fishCompletion(const std::vector<Command>& commands);

} // namespace patina::cli
