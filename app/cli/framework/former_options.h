// Options of earlier versions under their present names.
#pragma once

#include <string>
#include <vector>

namespace patina::cli {

// Returns the words of a command line, of which the first names the command, with each former
// option replaced by its present spelling and those without an effect left out.
std::vector<std::string> inPresentSpelling(std::vector<std::string> words);

} // namespace patina::cli
