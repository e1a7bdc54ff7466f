#include "app/cli/framework/suggestion.h"

#include <algorithm>

namespace patina::cli {

namespace {

std::size_t editsBetween(const std::string& a, const std::string& b) {
  const std::size_t width = b.size() + 1;
  // [i, j]: distance of the first i and j letters
  std::vector<std::size_t> edits((a.size() + 1) * width);
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      std::size_t& least = edits[i * width + j];
      if (i == 0 || j == 0) {
        least = i + j;
        continue;
      }
      const bool same = a[i - 1] == b[j - 1];
      least = std::min({edits[(i - 1) * width + j] + 1, edits[i * width + j - 1] + 1,
                        edits[(i - 1) * width + j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        least = std::min(least, edits[(i - 2) * width + j - 2] + 1);
    }
  return edits.back();
}

// Returns the known word at the smallest edit distance with transpositions (Damerau 1964), at most
// a third of the word and two; empty if none is that near.
std::string nearestWord(const std::string& word, const std::vector<std::string>& known) {
  std::string nearest;
  std::size_t least = std::min<std::size_t>(word.size() / 3, 2) + 1;
  for (const std::string& candidate : known)
    if (const std::size_t edits = editsBetween(word, candidate); edits < least) {
      least = edits;
      nearest = candidate;
    }
  return nearest;
}

} // namespace

std::string suggestion(const std::string& word, const std::vector<std::string>& known,
                       const std::string& otherwise) {
  const std::string nearest = nearestWord(word, known);
  return nearest.empty() ? otherwise : "; did you mean '" + nearest + "'?";
}

} // namespace patina::cli
