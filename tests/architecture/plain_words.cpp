#include "architecture/plain_words.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>

namespace patina::architecture {
namespace {

using WordSet = std::set<std::string, std::less<>>;

const WordSet kOpenings{"Of",     "By",     "With",  "Without", "To",      "Beside",  "Behind",
                        "Beyond", "Within", "Below", "Above",   "Between", "Through", "Against",
                        "Over",   "Under",  "From",  "Into",    "Onto",    "Until",   "Or",
                        "But",    "And",    "Else",  "So",      "Nor",     "Whose"};
const WordSet kClauses{"What", "Whatever", "Whoever", "Who"};
const WordSet kTrailing{"of", "by", "that", "which", "whose",  "where",  "but",   "and",
                        "or", "so", "else", "as",    "beside", "beyond", "until", "unless"};

bool isWordLetter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// The line without what stands in string and character literals, which become empty.
std::string withoutLiterals(const std::string& line) {
  std::string kept;
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote == 0 && c == '/' && i + 1 < line.size() && line[i + 1] == '/')
      return kept + line.substr(i);
    if (quote != 0) {
      if (c == '\\')
        ++i;
      else if (c == quote)
        quote = 0;
    } else if (c == '"' || (c == '\'' && (i == 0 || !isWordLetter(line[i - 1])))) {
      quote = c;
    } else {
      kept += c;
    }
  }
  return kept;
}

std::string firstWord(const std::string& text) {
  std::size_t begin = 0;
  while (begin < text.size() && text[begin] == ' ') ++begin;
  std::size_t end = begin;
  while (end < text.size() && isWordLetter(text[end])) ++end;
  return text.substr(begin, end - begin);
}

// Calls visit(number, line) for each line, from 1.
template <typename Visit> void forLines(const std::string& text, Visit visit) {
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) visit(++number, line);
}

} // namespace

std::vector<std::string> commentsWithoutSubject(const SourceFile& file) {
  std::vector<std::string> found;
  bool in_comment = false; // the line before is nothing but a comment
  forLines(file.text, [&](int number, const std::string& line) {
    const std::string bare = withoutLiterals(line);
    const std::size_t mark = bare.find("//");
    const bool alone = mark != std::string::npos &&
                       std::all_of(bare.begin(), bare.begin() + static_cast<std::ptrdiff_t>(mark),
                                   [](char c) { return c == ' '; });
    if (mark != std::string::npos && !(alone && in_comment)) {
      const std::string word = firstWord(bare.substr(mark + 2));
      if (kOpenings.contains(word) || (alone && kClauses.contains(word)) ||
          (!alone && kTrailing.contains(word)))
        found.push_back(file.path + ":" + std::to_string(number) + ": " + bare.substr(mark));
    }
    in_comment = alone;
  });
  return found;
}

std::vector<std::string> retiredWords(const SourceFile& file,
                                      const std::vector<std::string>& words) {
  const WordSet retired(words.begin(), words.end());
  std::vector<std::string> found;
  forLines(file.text, [&](int number, const std::string& line) {
    const std::string bare = withoutLiterals(line);
    if (bare.starts_with("#include")) return;
    for (std::size_t i = 0; i < bare.size();) {
      std::size_t end = i;
      while (end < bare.size() && isWordLetter(bare[end])) ++end;
      if (end > i && retired.contains(std::string_view(bare).substr(i, end - i)))
        found.push_back(file.path + ":" + std::to_string(number) + ": " + bare.substr(i, end - i));
      i = std::max(end, i + 1);
    }
  });
  return found;
}

} // namespace patina::architecture
