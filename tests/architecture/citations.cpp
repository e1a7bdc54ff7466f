#include "architecture/citations.h"

#include <cctype>
#include <regex>
#include <sstream>

namespace patina::architecture {

namespace {

const std::string kItem =
    R"((?:T-[A-Z]+[0-9]*[a-z]?|K[0-9]{2}[a-z]?|A[0-9]{2}|F[0-9]{1,2}|P[0-9]{2}))";
const std::string kNumber = R"([0-9](?:\.[0-9]+)*)";

// "a, b", "a and b" and "a to b" cite all of them.
void addNumbers(const std::string& list, std::vector<std::string>& cited) {
  static const std::regex number(kNumber);
  for (std::sregex_iterator at(list.begin(), list.end(), number), end; at != end; ++at)
    cited.push_back(at->str());
}

} // namespace

std::vector<std::string> definitionsIn(const std::string& mathematics) {
  static const std::regex definition("^(?:\\| (" + kItem + ") \\||#+ (" + kNumber +
                                     ")\\.? |- \\*\\*(" + kNumber + ")\\*\\*).*");
  std::vector<std::string> defined;
  std::istringstream lines(mathematics);
  std::smatch match;
  for (std::string line; std::getline(lines, line);)
    if (std::regex_match(line, match, definition))
      for (std::size_t group = 1; group <= 3; ++group)
        if (match[group].matched) defined.push_back(match[group]);
  return defined;
}

std::vector<std::string> unresolvedCitations(const SourceFile& file,
                                             const std::set<std::string>& defined) {
  static const std::regex item("(?:^|[^A-Za-z0-9_])(" + kItem + ")(?![A-Za-z0-9_])");
  static const std::regex sections("\\bMATH (" + kNumber + "(?:(?:,| and| to) " + kNumber +
                                   R"(\.[0-9]+)*))");
  static const std::regex nowhere(
      R"(\b(MATH|DESIGN|[Ss]ections? [0-9][0-9.]*)(?![A-Za-z0-9_])|//.*\b([0-9]\.[0-9]\.[0-9])\b)");
  std::vector<std::string> unresolved;
  std::istringstream lines(file.text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const auto fail = [&](const std::string& cited) {
      unresolved.push_back(file.path + ":" + std::to_string(number) + ": cites " + cited +
                           ", which docs/mathematics.md has not");
    };
    std::vector<std::string> cited;
    for (std::sregex_iterator at(line.begin(), line.end(), item), end; at != end; ++at)
      cited.push_back((*at)[1]);
    for (std::sregex_iterator at(line.begin(), line.end(), sections), end; at != end; ++at)
      addNumbers((*at)[1], cited);
    for (const std::string& each : cited)
      if (!defined.contains(each)) fail(each);
    const std::string rest = std::regex_replace(line, sections, "");
    for (std::sregex_iterator at(rest.begin(), rest.end(), nowhere), end; at != end; ++at)
      fail((*at)[1].matched ? (*at)[1].str() : (*at)[2].str());
  }
  return unresolved;
}

std::set<std::string> anchorsIn(const std::string& document) {
  std::set<std::string> anchors;
  std::istringstream lines(document);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t marks = line.find_first_not_of('#');
    if (marks == 0 || marks == std::string::npos || line[marks] != ' ') continue;
    std::string anchor;
    for (const char c : line.substr(marks + 1)) {
      const auto byte = static_cast<unsigned char>(c);
      if (std::isalnum(byte) || byte >= 0x80 || c == '_' || c == '-')
        anchor += static_cast<char>(std::tolower(byte));
      else if (c == ' ')
        anchor += '-';
    }
    anchors.insert(anchor);
  }
  return anchors;
}

} // namespace patina::architecture
