// Checks that links, files and items of docs/mathematics.md that documents and comments name exist.
#include <algorithm>
#include <regex>

#include "architecture/citations.h"

namespace patina::architecture {
namespace {

namespace fs = std::filesystem;

std::vector<SourceFile> documents() {
  return filesUnder({"README.md", "docs", "data"}, isDocument);
}

std::string textOf(const std::string& path) {
  return filesUnder({path}, [](const fs::path&) { return true; }).at(0).text;
}

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at)
    found.push_back((*at)[1]);
  return found;
}

TEST(Documents, EveryLinkLeadsToAFileAndItsHeading) {
  std::size_t links = 0;
  for (const SourceFile& document : documents()) {
    for (const std::string& link : matches(document.text, R"(\]\(([^)\s]+)\))")) {
      if (link.starts_with("http")) continue;
      ++links;
      const std::size_t hash = std::min(link.find('#'), link.size());
      const fs::path target = hash == 0
                                  ? fs::path(document.path)
                                  : (fs::path(document.path).parent_path() / link.substr(0, hash));
      ASSERT_TRUE(fs::exists(kRoot / target)) << document.path << " links " << link;
      if (hash < link.size()) {
        EXPECT_TRUE(anchorsIn(textOf(target)).contains(link.substr(hash + 1)))
            << document.path << " links " << link;
      }
    }
  }
  EXPECT_GT(links, 10u);
}

TEST(Documents, EveryNamedFileExists) {
  const std::vector<SourceFile> all =
      filesUnder({"README.md", "modules", "app", "tests", "docs", "data"},
                 [](const fs::path& path) { return isCode(path) || isDocument(path); });
  // A file is named by its path or by the end of it: `stage.h`, `servo/snapshot.h`.
  const auto exists = [&](const std::string& name) {
    return fs::exists(kRoot / name) ||
           std::any_of(all.begin(), all.end(),
                       [&](const SourceFile& file) { return file.path.ends_with("/" + name); });
  };
  std::size_t named = 0;
  const auto check = [&](const SourceFile& file, const std::string& pattern) {
    for (const std::string& name : matches(file.text, pattern)) {
      ++named;
      EXPECT_TRUE(exists(name)) << file.path << " names " << name;
    }
  };
  for (const SourceFile& document : documents()) {
    check(document, R"(`((?:modules|app|tests|docs|data)/[A-Za-z0-9_./-]*)`)");
    check(document, R"(`([A-Za-z0-9_./-]+\.(?:h|cpp|md))`)");
  }
  const std::size_t in_documents = named;
  EXPECT_GT(in_documents, 40u);
  for (const SourceFile& file : filesUnder({"modules", "app", "tests"}, isCode))
    check(file, R"(//[^\n]*\b(docs/[A-Za-z0-9_]+\.md))");
  EXPECT_GT(named, in_documents);
}

TEST(Documents, MathematicsContainEveryCitedItemAndSection) {
  const std::vector<std::string> definitions = definitionsIn(textOf("docs/mathematics.md"));
  const std::set<std::string> defined(definitions.begin(), definitions.end());
  EXPECT_EQ(defined.size(), definitions.size()) << "something is defined twice";
  EXPECT_GT(defined.size(), 100u);
  const auto any = [](const fs::path& path) { return isCode(path) || isDocument(path); };
  for (const SourceFile& file :
       filesUnder({"README.md", "modules", "app", "tests", "docs", "data"}, any)) {
    if (file.path.starts_with("tests/architecture/")) continue; // the checker's made-up citations
    for (const std::string& cause : unresolvedCitations(file, defined)) ADD_FAILURE() << cause;
  }
}

TEST(Documents, CheckerFindsDefinitionsInTheMathematics) {
  EXPECT_EQ(definitionsIn("# Title\n## 2. Loops\n### 2.1 A wall\n- **2.1.7** In space.\n"
                          "| Item | Says |\n|---|---|\n| K05 | direction, as K04 |\n"
                          "| T-K06b | order 2 |\nF13 in a line of text\n"),
            (std::vector<std::string>{"2", "2.1", "2.1.7", "K05", "T-K06b"}));
  EXPECT_EQ(anchorsIn("# One\ntext\n## K*(x), where?\n#no\n"),
            (std::set<std::string>{"one", "kx-where"}));
}

TEST(Documents, CheckerFindsCitationsWithoutATarget) {
  const std::set<std::string> defined{"K05", "F1", "P01", "T-K06b", "T-ENER", "2", "2.1", "2.1.2"};
  const auto found = [&](const std::string& line) {
    return unresolvedCitations({"a.h", "// first\n" + line + "\n"}, defined);
  };
  for (const char* line :
       {"// as K99 has it", "// (K05, K06)", "// K05b", "// F2", "// F13", "// P02-P01", "// A10",
        "// T-K06c", "// T-SAFE,", "// MATH 2.2", "// MATH 2.1.3", "// MATH 2.1, 2.2",
        "// MATH 2.1.2 to 2.1.4", "// MATH section 2.1", "// MATH K05", "// DESIGN 5",
        "// section 2.1", "// Section 2", "// so it is (2.1.2)"}) {
    ASSERT_FALSE(found(line).empty()) << line;
    EXPECT_TRUE(found(line)[0].starts_with("a.h:2: cites ")) << found(line)[0];
  }
  for (const char* line :
       {"// K05, F1 and P01: T-K06b, T-ENER.", "// MATH 2, 2.1 and 2.1.2; MATH 2.", "KEY05 MK05 K5",
        "-D PATINA_MATH", "version 2.1.3", "// the section here", "// F100, OF1, A1"})
    EXPECT_TRUE(found(line).empty()) << line << ": " << found(line)[0];
}

// The README promises exactly two commands; both must exist and start.
TEST(Documents, ReadmesTwoCommandsStart) {
  const std::vector<std::string> commands =
      matches(textOf("README.md"), R"(\n    ([a-z]+/[a-z]+\.sh))");
  EXPECT_EQ(commands, (std::vector<std::string>{"app/run.sh", "tests/run.sh"}));
  for (const std::string& command : commands)
    EXPECT_NE(fs::status(kRoot / command).permissions() & fs::perms::owner_exec, fs::perms::none);
}

} // namespace
} // namespace patina::architecture
