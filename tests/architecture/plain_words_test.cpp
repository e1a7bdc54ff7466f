#include "architecture/plain_words.h"

#include <set>
#include <sstream>

namespace patina::architecture {
namespace {

constexpr std::size_t kMaxExceptions = 60;

std::vector<std::string> linesOf(const std::string& path) {
  std::istringstream text(filesUnder({path}, [](const auto&) { return true; }).at(0).text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);)
    if (!line.empty() && line[0] != '#') lines.push_back(line);
  return lines;
}

std::vector<SourceFile> sources() {
  return filesUnder({"modules", "app", "tests"}, [](const std::filesystem::path& path) {
    return path.extension() == ".h" || path.extension() == ".cpp";
  });
}

// An exception is listed as "path: // text", without the line's number, which changes.
std::string withoutNumber(const std::string& violation) {
  const std::size_t path = violation.find(':');
  return violation.substr(0, path) + violation.substr(violation.find(':', path + 1));
}

TEST(PlainWords, EveryCommentHasASubject) {
  const std::vector<std::string> listed = linesOf("tests/architecture/comment_exceptions.txt");
  const std::set<std::string> exceptions(listed.begin(), listed.end());
  EXPECT_LE(exceptions.size(), kMaxExceptions);
  std::set<std::string> used;
  for (const SourceFile& file : sources())
    for (const std::string& violation : commentsWithoutSubject(file)) {
      const std::string text = withoutNumber(violation);
      used.insert(text);
      EXPECT_TRUE(exceptions.contains(text)) << violation;
    }
  for (const std::string& exception : exceptions)
    EXPECT_TRUE(used.contains(exception)) << "no longer needed: " << exception;
}

TEST(PlainWords, RetiredWordsStayAway) {
  const std::vector<std::string> words = linesOf("tests/architecture/retired_words.txt");
  for (const SourceFile& file : sources())
    for (const std::string& violation : retiredWords(file, words)) ADD_FAILURE() << violation;
}

TEST(PlainWords, CheckerSeesCommentsWithoutSubject) {
  for (const char* line : {"// Of the fit, as others are judged.", "  // What is felt.",
                           "int n = 0; // of the mesh", "// But not for thin parts."})
    EXPECT_EQ(commentsWithoutSubject({"a.h", std::string(line) + "\n"}).size(), 1u) << line;
  for (const char* line :
       {"// Returns the fit's cost.", "int n = 0; // number of faces",
        "// The first line\n// of a comment with two.", "auto s = \"// of a string\";"})
    EXPECT_TRUE(commentsWithoutSubject({"a.h", std::string(line) + "\n"}).empty()) << line;
}

TEST(PlainWords, CheckerSeesWordsButNotStrings) {
  const std::vector<std::string> words{"evenness"};
  EXPECT_EQ(retiredWords({"a.h", "double evenness(); // evenness\n"}, words).size(), 2u);
  EXPECT_TRUE(retiredWords({"a.h", "json[\"evenness\"] = unevenness;\n"}, words).empty());
}

} // namespace
} // namespace patina::architecture
