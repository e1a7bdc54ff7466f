// feel and sample over long tables: memory does not grow with them, and the output is complete or
// absent.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/file.h"
#include "core/numbers.h"
#include "integration/program.h"

namespace patina::test {
namespace {

constexpr std::size_t kRows = 300000;

class LongTables : public testing::Test {
 protected:
  void SetUp() override {
    mesh = folder / "sphere.ply";
    ASSERT_EQ(run({"model", "sphere", "-o", mesh}).exit, 0);
  }

  // Writes the path of a tip into the sphere and out again; the last row is `last`.
  std::string table(bool with_time, std::size_t rows, const std::string& last = "") const {
    std::string text = std::string(with_time ? "t [s]," : "") + "x [m],y [m],z [m]\n";
    for (std::size_t i = 0; i < rows; ++i) {
      if (with_time) text += formatNumber(1e-3 * static_cast<double>(i)) + ",";
      text += "0,0," + formatNumber(0.04 + 1e-6 * static_cast<double>(i % 20000)) + "\n";
    }
    return folder.write("in.csv", text + last);
  }

  // Peak resident memory [kB] of the program alone, and its exit code.
  static double peak(std::vector<std::string> words) {
    words.insert(words.begin(), programPath().string());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      if (!std::freopen("/dev/null", "w", stdout) || !std::freopen("/dev/null", "w", stderr))
        _exit(1);
      execv(argv[0], argv.data());
      _exit(127);
    }
    int status = 0;
    rusage usage{};
    EXPECT_EQ(wait4(child, &status, 0, &usage), child);
    EXPECT_EQ(status, 0);
    return static_cast<double>(usage.ru_maxrss);
  }

  std::size_t lines(const std::string& file) const {
    const std::string text = readFile(folder / file);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  void expectNothingBeside(std::size_t files) const {
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}),
              static_cast<std::ptrdiff_t>(files));
  }

  ScratchFolder folder;
  std::string mesh;
};

TEST_F(LongTables, TakeConstantMemoryForTwiceTheRows) {
  for (const bool feel : {true, false}) {
    const std::string input = folder / "in.csv";
    const std::vector<std::string> words = {
        feel ? "feel" : "sample",     mesh,  "--resolution", "60",
        feel ? "--path" : "--points", input, "-o",           folder / "out.csv"};
    table(feel, kRows);
    const double once = peak(words);
    EXPECT_EQ(lines("out.csv"), kRows + 1);
    table(feel, 2 * kRows);
    const double twice = peak(words);
    EXPECT_EQ(lines("out.csv"), 2 * kRows + 1);
    std::printf("%s: %.1f MB for %zu rows, %.1f MB for twice as many\n", words[0].c_str(),
                once / 1024, kRows, twice / 1024);
    // [kB]. Rows in memory take some 500 bytes each, which would be 150 MB; an allocator's arenas
    // for other threads take a few.
    EXPECT_LT(twice, once + 20e3) << words[0];
  }
}

TEST_F(LongTables, KeepTheOldOutputIfTheLastRowIsBad) {
  folder.write("out.csv", "x [m],y\n1,2\n");
  for (const bool feel : {true, false}) {
    const std::string input = table(feel, 20000, feel ? "99,0,0,oops\n" : "0,0,oops\n");
    expectOneLineError(run({feel ? "feel" : "sample", mesh, "--resolution", "60",
                            feel ? "--path" : "--points", input, "-o", folder / "out.csv"}),
                       {"in.csv:20002:", "'oops' is not a number"});
    EXPECT_EQ(readFile(folder / "out.csv"), "x [m],y\n1,2\n");
    expectNothingBeside(3);
  }
}

} // namespace
} // namespace patina::test
