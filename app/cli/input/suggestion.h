// What a person who mistyped a word may have meant.
#pragma once

#include <string>
#include <vector>

namespace patina::cli {

// "; did you mean 'info'?", or `otherwise` if no word is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& known,
                       const std::string& otherwise);

} // namespace patina::cli
