// patina study --quick: tables as CSV and JSON, with the machine they were measured on.
#include <gtest/gtest.h>

#include <sstream>

#include "core/file.h"
#include "integration/program.h"

namespace patina::test {
namespace {

TEST(Studies, WriteTablesWithTheMachinesName) {
  const ScratchFolder folder;
  const Json report = runJson({"study", "field", "-o", folder / "out", "--quick"});
  for (const char* key : {"rows", "order_fitted", "order_expected", "tables", "files"})
    EXPECT_NE(report.find(key), nullptr) << key;
  ASSERT_FALSE(report.at("rows").asArray().empty());
  for (const Json& row : report.at("rows").asArray())
    for (const char* key : {"error", "error_max", "ns", "bytes"})
      EXPECT_NE(row.find(key), nullptr) << key;
  std::size_t rows = 0;
  int tables = 0;
  for (const Json& file : report.at("files").asArray()) {
    const std::string path = folder / ("out/" + file.asString());
    const std::string text = readFile(path);
    if (path.ends_with(".json")) {
      const Json table = parseJson(text, path);
      EXPECT_NE(table.find("machine"), nullptr);
      EXPECT_NE(table.find("program"), nullptr);
      rows += table.at("rows").asArray().size();
      ++tables;
    } else if (path.ends_with(".csv")) {
      EXPECT_NE(firstLine(path).find("ns,bytes"), std::string::npos) << firstLine(path);
    } else {
      EXPECT_EQ(text.substr(1, 3), "PNG");
    }
  }
  EXPECT_GE(tables, 1);
  EXPECT_EQ(rows, report.at("rows").asArray().size());
}

TEST(Studies, PrintTheTableAndReportMissingPlots) {
  const ScratchFolder folder;
  const Outcome outcome = Running({"-u", "DISPLAY", programPath().string(), "study", "field", "-o",
                                   folder / "out", "--quick"},
                                  "env")
                              .wait();
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_NE(outcome.out.find("sampler"), std::string::npos);
  EXPECT_NE(outcome.err.find("xvfb-run"), std::string::npos);
}

// Contact and stability have the tables with the most columns.
TEST(Studies, PrintNoLineTooLongForATerminal) {
  const ScratchFolder folder;
  for (const std::string study : {"contact", "stability"}) {
    const Outcome outcome = run({"study", study, "-o", folder / "out", "--quick"});
    ASSERT_EQ(outcome.exit, 0) << outcome.err;
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);)
      if (line.find(folder.path().string()) == std::string::npos) {
        EXPECT_LE(line.size(), 120u) << line;
      }
    // The printed table has every column but the program that made it, which is the running one; a
    // title may break between words.
    std::string words;
    std::istringstream text(outcome.out);
    for (std::string word; text >> word;) words += word + " ";
    std::istringstream names(firstLine(folder / ("out/" + study + "-1.csv")));
    for (std::string name; std::getline(names, name, ',');)
      if (name != "program") {
        EXPECT_NE(words.find(name), std::string::npos) << study << ": " << name;
      }
  }
}

TEST(Studies, ListKnownNamesForAnUnknownOne) {
  const ScratchFolder folder;
  expectOneLineError(run({"study", "weather", "-o", folder / "out"}), {"weather", "field", "all"});
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

} // namespace
} // namespace patina::test
