// Reads texts whose comments begin with '#'.
#pragma once

#include <filesystem>
#include <string>

namespace patina {

// Reads a text file as readFile() does, but keeps only '#' of a comment line, and 4 kB of a comment
// that follows other words, so that comments take no memory. A comment ends with its line. Pipes
// and devices keep their comments.
std::string readCommented(const std::filesystem::path& path);

} // namespace patina
