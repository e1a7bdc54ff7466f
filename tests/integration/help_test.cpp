// --help, --version, manual pages and the user's documents say the same.
#include <gtest/gtest.h>

#include <chrono>
#include <sstream>

#include "core/file.h"
#include "integration/program.h"

namespace patina::test {
namespace {

// The names in the list of patina --help.
std::vector<std::string> commands() {
  std::istringstream help(run({"--help"}).out);
  std::vector<std::string> names;
  bool in_list = false;
  for (std::string line; std::getline(help, line);) {
    if (line == "Commands:")
      in_list = true;
    else if (in_list && line.empty())
      break;
    else if (in_list && line.size() > 2 && line[2] != ' ')
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return names;
}

// The long options of one command, by its --help.
std::vector<std::string> options(const std::string& command) {
  std::istringstream help(run({command, "--help"}).out);
  std::vector<std::string> names;
  bool in_list = false;
  for (std::string line; std::getline(help, line);) {
    if (line == "Options:")
      in_list = true;
    else if (in_list && line.empty())
      break;
    else if (in_list && line.starts_with("  -")) {
      const std::size_t begin = line.find("--");
      names.push_back(line.substr(begin, line.find(' ', begin) - begin));
    }
  }
  return names;
}

TEST(Help, ListsTheCommandsOfThisVersion) {
  const std::vector<std::string> expected = {"info",         "scene",  "field", "sample", "feel",
                                             "render",       "export", "study", "model",  "devices",
                                             "latency-test", "gui",    "man"};
  EXPECT_EQ(commands(), expected);
}

TEST(Help, OfEachCommandShowsOptionsExampleAndExitCodes) {
  for (const std::string& command : commands()) {
    const Outcome help = run({command, "--help"});
    EXPECT_EQ(help.exit, 0);
    EXPECT_EQ(help.err, "");
    for (const std::string& part :
         {"Usage: patina " + command, std::string("\n  patina ") + command,
          std::string("Exit codes:"), std::string("--help")})
      EXPECT_NE(help.out.find(part), std::string::npos) << command << ": " << part;
    std::istringstream lines(help.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
    EXPECT_EQ(run({command, "-h"}).out, help.out);
  }
}

TEST(Help, FeelHasExactlyTheOptionsOfThisVersion) {
  const std::vector<std::string> expected = {"--path",
                                             "--output",
                                             "--stiffness",
                                             "--damping",
                                             "--friction-static",
                                             "--friction-dynamic",
                                             "--friction-depth",
                                             "--friction-slip",
                                             "--tip-radius",
                                             "--force-limit",
                                             "--resolution",
                                             "--voxel",
                                             "--band",
                                             "--sampler",
                                             "--unit",
                                             "--iso",
                                             "--json",
                                             "--help"};
  EXPECT_EQ(options("feel"), expected);
}

TEST(Help, ShowsDefaultsAndUnits) {
  const std::string help = run({"feel", "--help"}).out;
  for (const char* part : {"[N/m]", "[500]", "[3.3]", "[150]", "[8]", "[mm]", "1.5mm"})
    EXPECT_NE(help.find(part), std::string::npos) << part;
}

TEST(Help, OfSceneNamesEveryKeyThatASceneHas) {
  const ScratchFolder folder;
  const std::string help = run({"scene", "--help"}).out;
  const std::string error = run({"scene", "-o", folder / "w", "--set", "no.such=1"}).err;
  std::istringstream words(error.substr(error.find("known are:") + 10));
  int keys = 0;
  for (std::string key; words >> key; ++keys) EXPECT_NE(help.find(key), std::string::npos) << key;
  EXPECT_GE(keys, 13) << error;
}

TEST(Help, VersionIsOneLine) {
  for (const auto& words : {std::vector<std::string>{"--version"}, {"info", "--version"}}) {
    const Outcome version = run(words);
    EXPECT_EQ(version.exit, 0);
    EXPECT_TRUE(version.out.starts_with("patina 0.")) << version.out;
    EXPECT_EQ(std::count(version.out.begin(), version.out.end(), '\n'), 1);
  }
}

TEST(Help, ComesWithinFiftyMilliseconds) {
  double best = 1e9;
  for (int i = 0; i < 10; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    run({"--help"});
    best = std::min(
        best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  EXPECT_LE(best, 0.050);
}

TEST(ManualPages, ExistForTheProgramAndEveryCommandWithTheHelpsOptions) {
  const ScratchFolder folder;
  ASSERT_EQ(run({"man", "-o", folder / "man1"}).exit, 0);
  const std::string program = readFile(folder / "man1/patina.1");
  EXPECT_TRUE(program.starts_with(".TH PATINA 1"));
  std::size_t pages = 1;
  for (const std::string& command : commands()) {
    std::string escaped = "patina\\-" + command;
    if (command == "latency-test") escaped = "patina\\-latency\\-test";
    EXPECT_NE(program.find(escaped), std::string::npos) << command;
    const std::string page = readFile(folder / ("man1/patina-" + command + ".1"));
    for (const std::string& option : options(command)) {
      std::string name;
      for (const char c : option) name += c == '-' ? std::string("\\-") : std::string(1, c);
      EXPECT_NE(page.find(name), std::string::npos) << command << " " << option;
    }
    for (const char* part : {".SH NAME", ".SH SYNOPSIS", ".SH EXAMPLES", ".SH EXIT STATUS"})
      EXPECT_NE(page.find(part), std::string::npos) << command << " " << part;
    ++pages;
  }
  std::size_t files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder / "man1")) {
    (void)file;
    ++files;
  }
  EXPECT_EQ(files, pages);
}

// The documents that a person reads.
std::string document(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(PATINA_SOURCE_DIR) / name;
  return std::filesystem::exists(path) ? readFile(path) : "";
}

TEST(Documents, ShowEveryCommand) {
  const std::string text = document("docs/user_guide.md") + document("README.md");
  if (text.empty()) GTEST_SKIP() << "docs/user_guide.md is not there";
  for (const std::string& command : commands())
    EXPECT_NE(text.find("patina " + command), std::string::npos) << command;
}

TEST(Documents, FileFormatsHaveTheColumnsThatTheProgramWrites) {
  const std::string text = document("docs/file_formats.md");
  if (text.empty()) GTEST_SKIP() << "docs/file_formats.md is not there";
  const ScratchFolder folder;
  const std::string box = folder / "box.ply";
  const std::string tips = folder.write("tip.csv", "t [s],x [m],y [m],z [m]\n0,0,0,0.1\n");
  const std::string points = folder.write("points.csv", "x [m],y [m],z [m]\n0,0,0.1\n");
  ASSERT_EQ(run({"model", "box", "-o", box}).exit, 0);
  ASSERT_EQ(run({"feel", box, "--path", tips, "-o", folder / "f.csv", "--resolution", "40"}).exit,
            0);
  ASSERT_EQ(
      run({"sample", box, "--points", points, "-o", folder / "s.csv", "--resolution", "40"}).exit,
      0);
  for (const char* file : {"tip.csv", "points.csv", "f.csv", "s.csv"})
    EXPECT_NE(text.find(firstLine(folder / file)), std::string::npos) << firstLine(folder / file);
}

} // namespace
} // namespace patina::test
