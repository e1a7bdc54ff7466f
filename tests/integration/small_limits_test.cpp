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
    if (outcome.exit == 0) return;
    const std::string what = line.name + " under ulimit " + limit + ": " + outcome.err;
    EXPECT_EQ(outcome.exit, 2) << what;
    // Where not even the program's libraries fit, the system's loader says so itself.
    const bool loaded =
        outcome.err.find("error while loading shared libraries") == std::string::npos;
    if (loaded) {
      EXPECT_TRUE(outcome.err.find("patina: ") != std::string::npos) << what;
    }
    EXPECT_EQ(names(), before) << what;
  }

  std::vector<CommandLine> all() const {
    std::vector<CommandLine> lines = commands();
    lines.push_back({"info", {"info", workspace}, ""});
    lines.push_back({"render", {"render", workspace, "-o", "OUT"}, ".png"});
    lines.push_back({"undo", {"undo", workspace, "--list"}, ""});
    return lines;
  }
};

TEST_F(SmallLimits, OfAddressSpace) {
  const long steps = longer(3) > 3 ? 30 : 3;
  for (long i = 0; i <= steps; ++i)
    for (const CommandLine& line : all())
      expectLineOrSuccess("-v " + std::to_string(300000 + 300000 * i / steps), line);
}

TEST_F(SmallLimits, OfFilesAndDescriptors) {
  for (const char* limit : {"-f 1", "-f 16", "-n 6", "-n 9", "-n 14"})
    for (const CommandLine& line : all()) expectLineOrSuccess(limit, line);
}

} // namespace
} // namespace patina::test
