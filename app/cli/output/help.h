// --help and man pages, both written from the same Command values.
#pragma once

#include <string>
#include <vector>

#include "app/cli/commands/command.h"

namespace patina::cli {

constexpr std::size_t kHelpWidth = 80;

// Words of `text`, wrapped at `width`, each line after the first indented; the first begins at
// `column`.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t column,
                    std::size_t width = kHelpWidth);

// Of the program: what every command has in common and the list of commands.
std::string programHelp(const std::vector<Command>& commands);
std::string commandHelp(const Command& command);

// The manual's pages, roff: patina.1 and patina-COMMAND.1.
std::string programManPage(const std::vector<Command>& commands);
std::string commandManPage(const Command& command);

// The --help of everything as one document.
std::string markdown(const std::vector<Command>& commands);

} // namespace patina::cli
