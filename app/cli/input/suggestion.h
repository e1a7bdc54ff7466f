// What a person who mistyped a word may have meant.
#pragma once

#include <string>
#include <vector>

namespace patina::cli {

// The known word that takes the fewest letters put in, left out, changed or swapped with the next
// one, at most a third of the word and two; empty if none is so near.
std::string nearestWord(const std::string& word, const std::vector<std::string>& known);

// "; did you mean 'info'?", or `otherwise` if nothing is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& known,
                       const std::string& otherwise);

} // namespace patina::cli
