// Writes --help and man pages from the same Command values.
#pragma once

#include <string>
#include <vector>

#include "app/cli/framework/command.h"

namespace patina::cli {

constexpr std::size_t kHelpWidth = 80;

// Wraps `text` at `width`; the first line begins at `column`, the others are indented.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t column,
                    std::size_t width = kHelpWidth);

// Help of the program: the list of commands and their common options.
std::string programHelp(const std::vector<Command>& commands);
std::string commandHelp(const Command& command);

// Manual pages in roff: patina.1 and patina-COMMAND.1.
std::string programManPage(const std::vector<Command>& commands);
std::string commandManPage(const Command& command);

std::string markdown(const std::vector<Command>& commands);

} // namespace patina::cli
