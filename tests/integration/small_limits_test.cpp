// Little memory, small files and few descriptors: a line and exit 2, or success; never a signal.
#include <gtest/gtest.h>

#include "integration/every_command.h"
#include "support/longer.h"
#include "support/sanitized.h"

namespace patina::test {
namespace {

class SmallLimits : public EveryCommand {
 protected:
  Outcome limited(const std::string& limit, const std::vector<std::string>& words) const {
    std::vector<std::string> all = {"-c", "ulimit " + limit + " && exec \"$0\" \"$@\"",
                                    programPath().string()};
    all.insert(all.end(), words.begin(), words.end());
    return Running(all, "/bin/bash").wait();
  }

  void expectLineOrSuccess(const std::string& limit, const CommandLine& line) const {
    const std::string out = folder / ("out" + line.extension);
    std::filesystem::remove_all(out);
    const std::vector<std::string> before = names();
    const Outcome outcome = limited(limit, line.to(out));
    if (outcome.exit <= 1) return; // 1: it did not converge
    const std::string what = line.name + " under ulimit " + limit + ": " + outcome.err;
    EXPECT_EQ(outcome.exit, 2) << what;
    // The system's loader reports the error if not even the program's libraries fit.
    const bool loaded =
        outcome.err.find("error while loading shared libraries") == std::string::npos;
    if (loaded) {
      EXPECT_TRUE(outcome.err.find("patina: ") != std::string::npos) << what;
    }
    if (line.name == "record") std::filesystem::remove_all(out); // partial recording
    EXPECT_EQ(names(), before) << what;
  }

  // Each command runs under each limit, in the short form under two of them, in alternation.
  void expectOfAll(const std::vector<std::string>& limits) const {
    std::size_t turn = 0;
    for (const CommandLine& line : all())
      for (std::size_t i = 0; i < (long_ ? limits.size() : 2); ++i)
        expectLineOrSuccess(limits[long_ ? i : turn++ % limits.size()], line);
  }

  std::vector<CommandLine> all() const {
    std::vector<CommandLine> lines = commands();
    if (long_) {
      makeScan();
      for (const auto& more : {scanFileCommands(), scanFolderCommands()})
        lines.insert(lines.end(), more.begin(), more.end());
      lines.push_back({"simulate-device", {"simulate-device", "probe", "--seconds", "0.2"}, ""});
      lines.push_back({"latency-test", {"latency-test", "--seconds", "0.2"}, ""});
      lines.push_back({"devices", {"devices"}, ""});
      lines.push_back({"study", {"study", "filter", "--quick", "-o", "OUT"}, "", Writes::folder});
      lines.push_back({"help", {"help", "feel"}, ""});
      lines.push_back({"completion", {"completion", "zsh"}, ""});
    }
    lines.push_back({"info", {"info", workspace}, ""});
    lines.push_back({"render", {"render", workspace, "-o", "OUT"}, ".png"});
    lines.push_back({"undo", {"undo", workspace, "--list"}, ""});
    return lines;
  }

  const bool long_ = longer(1) > 1;
};

TEST_F(SmallLimits, AddressSpaceGivesALineOrSuccess) {
  std::vector<std::string> limits;
  const long steps = long_ ? 30 : 3;
  for (long i = 0; i <= steps; ++i)
    limits.push_back("-v " + std::to_string(300000 + 300000 * i / steps));
  expectOfAll(limits);
}

TEST_F(SmallLimits, FilesAndDescriptorsGiveALineOrSuccess) {
  expectOfAll({"-f 1", "-n 6", "-f 16", "-n 9", "-n 14"});
}

} // namespace
} // namespace patina::test
