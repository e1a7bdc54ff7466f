// What the documents point at exists: links, and files named in `code`.
#include <fstream>
#include <regex>
#include <sstream>

namespace patina {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = PATINA_SOURCE_DIR;

std::vector<fs::path> documents() {
  std::vector<fs::path> found{kRoot / "README.md"};
  for (const char* folder : {"docs", "data"})
    for (const fs::directory_entry& item : fs::recursive_directory_iterator(kRoot / folder))
      if (item.path().extension() == ".md") found.push_back(item.path());
  return found;
}

std::string textOf(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at)
    found.push_back((*at)[1]);
  return found;
}

TEST(Documents, EveryLinkLeadsToAFile) {
  std::size_t links = 0;
  for (const fs::path& document : documents()) {
    for (std::string link : matches(textOf(document), R"(\]\(([^)\s]+)\))")) {
      if (link.starts_with("http") || link.starts_with("#")) continue;
      ++links;
      link = link.substr(0, link.find('#'));
      EXPECT_TRUE(fs::exists(document.parent_path() / link)) << document << " links " << link;
    }
  }
  EXPECT_GT(links, 10u);
}

TEST(Documents, EveryFileThatIsNamedExists) {
  std::size_t named = 0;
  for (const fs::path& document : documents()) {
    for (const std::string& path :
         matches(textOf(document), R"(`((?:modules|app|tests|docs|data)/[A-Za-z0-9_./-]*)`)")) {
      ++named;
      EXPECT_TRUE(fs::exists(kRoot / path)) << document << " names " << path;
    }
  }
  EXPECT_GT(named, 20u);
}

// The README promises exactly two commands, and both are there and can be started.
TEST(Documents, TheTwoCommandsOfTheReadmeCanBeStarted) {
  const std::vector<std::string> commands =
      matches(textOf(kRoot / "README.md"), R"(\n    ([a-z]+/[a-z]+\.sh))");
  EXPECT_EQ(commands, (std::vector<std::string>{"app/run.sh", "tests/run.sh"}));
  for (const std::string& command : commands)
    EXPECT_NE(fs::status(kRoot / command).permissions() & fs::perms::owner_exec, fs::perms::none);
}

} // namespace
} // namespace patina
