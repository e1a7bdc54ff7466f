// Suggests the intended word for a misspelt one.
#pragma once

#include <string>
#include <vector>

namespace patina::cli {

// Returns "; did you mean 'info'?", or `otherwise` if no word is similar.
std::string suggestion(const std::string& word, const std::vector<std::string>& known,
                       const std::string& otherwise);

} // namespace patina::cli
