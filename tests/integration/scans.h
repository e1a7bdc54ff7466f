// A ball, a simulated scan of it, and the file of its path.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/file.h"
#include "integration/program.h"

namespace patina::test {

class Scans : public testing::Test {
 protected:
  void SetUp() override {
    ball = folder / "ball.ply";
    ASSERT_EQ(run({"model", "sphere", "-o", ball}).exit, 0);
    scan = folder / "scan";
    path = folder / "path.csv";
  }
  Json simulate(std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"simulate-scan", ball, "-o", scan};
    words.insert(words.end(), more.begin(), more.end());
    return runJson(words);
  }
  void refused(const std::string& file, const std::string& text,
               const std::vector<std::string>& parts) const {
    const std::string kept = readFile(scan + "/" + file);
    writeFileAtomically(scan + "/" + file, text);
    expectOneLineError(run({"filter", scan, "-o", path}), parts);
    EXPECT_FALSE(std::filesystem::exists(path));
    writeFileAtomically(scan + "/" + file, kept);
  }

  ScratchFolder folder;
  std::string ball, scan, path;
};

} // namespace patina::test
