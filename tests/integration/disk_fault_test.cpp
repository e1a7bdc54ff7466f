// The program on a disk that refuses, and what it loads at its start.
#include <cstdlib>

#include <gtest/gtest.h>

#include "core/file.h"
#include "integration/program.h"
#include "support/places.h"

namespace patina::test {
namespace {

// For the programs that are started while it lives.
TEST(DiskFault, ARefusedSaveIsOneLineAndExit2AndTheWorkspaceStays) {
  const ScratchFolder scratch;
  const std::string folder = scratch / "pot", mark = scratch / "mark";
  const std::filesystem::path source = sourceFolder();
  const std::string mesh = source / "tests" / "fuzz" / "corpus" / "ply" / "ascii.ply";
  ASSERT_EQ(run({"scene", "-o", folder, "--add", mesh}).exit, 0);
  int refused = 0;
  for (int at = 1; at < 100; ++at) {
    const std::string before = readFile(folder + "/workspace.json");
    std::filesystem::remove(mark);
    Outcome outcome;
    {
      const Environment fault({{"LD_PRELOAD", programFolder() / "fault_shim.so"},
                               {"PATINA_FAULT", "full"},
                               {"PATINA_FAULT_AT", std::to_string(at)},
                               {"PATINA_FAULT_UNDER", folder},
                               {"PATINA_FAULT_MARK", mark}});
      outcome = run({"scene", "-o", folder, "--set", "stiffness=" + std::to_string(100 + at)});
    }
    EXPECT_EQ(run({"info", folder}).exit, 0) << "refused at call " << at;
    if (!std::filesystem::exists(mark)) {
      EXPECT_EQ(outcome.exit, 0);
      break;
    }
    expectOneLineError(outcome, {folder, "No space left on device"});
    if (readFile(folder + "/workspace.json") == before) ++refused;
  }
  EXPECT_GE(refused, 5); // fewer would mean that the shim is not there
}

TEST(Start, LoadsNoLibraryOfPictures) {
  const Environment trace(std::vector<std::pair<std::string, std::string>>{{"LD_DEBUG", "files"}});
  const Outcome outcome = run({"--help"});
  EXPECT_NE(outcome.err.find("libstdc++"), std::string::npos); // the trace is there
  EXPECT_EQ(outcome.err.find("OpenImageIO"), std::string::npos);
  EXPECT_EQ(outcome.err.find("patina_images"), std::string::npos);
}

} // namespace
} // namespace patina::test
