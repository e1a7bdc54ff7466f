// app/run.sh with stand-ins for what it builds and calls: which object it chooses, what it refuses.
#include <gtest/gtest.h>

#include "core/file.h"
#include "integration/program.h"
#include "support/places.h"

namespace patina::test {
namespace {

namespace fs = std::filesystem;

class RunScript : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"app", "build/bin", "tools"})
      fs::create_directories(folder.path() / name);
    for (const std::string name : {"app/run.sh", "app/packages.sh"})
      fs::copy_file(sourceFolder() / name, folder.path() / name);
    const std::string log = "echo \"${0##*/} $*\" >>'" + (folder / "log.txt") + "'\n";
    for (const char* name : {"build/bin/patina", "build/bin/patina-gui", "tools/ninja"})
      program(name, log);
    program("tools/cmake", log);
    program("tools/xvfb-run", "shift 3\nexec \"$@\"\n");
    for (const char* name : {"dirname", "mkdir", "cat", "nproc", "awk", "sh"})
      fs::create_symlink(fs::path("/usr/bin") / name, folder.path() / "tools" / name);
  }
  void program(const std::string& name, const std::string& body) const {
    fs::permissions(folder.write(name, "#!/bin/sh\n" + body), fs::perms::owner_all);
  }
  Outcome runScript(const std::vector<std::string>& words) const {
    std::vector<std::string> all = {"-i",
                                    "PATH=" + (folder / "tools"),
                                    "PATINA_INSTALL=no",
                                    "PATINA_OUT=" + (folder / "out"),
                                    "/bin/sh",
                                    folder / "app/run.sh"};
    all.insert(all.end(), words.begin(), words.end());
    return Running(all, "/usr/bin/env").wait();
  }

  ScratchFolder folder;
};

TEST_F(RunScript, ChoosesTheDinosaurWhenOnlyOptionsAreGiven) {
  const Outcome outcome = runScript({"--unit", "cm"});
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  const std::string log = readFile(folder / "log.txt");
  EXPECT_NE(log.find("patina model dinosaur"), std::string::npos) << log;
  EXPECT_NE(log.find("patina info " + (folder / "out/dinosaur.ply") + " --json"), std::string::npos)
      << log;
  EXPECT_EQ(log.find("--unit"), std::string::npos) << log; // it is in millimetres
}

TEST_F(RunScript, TakesAScanToAFeelWithoutAnArgument) {
  const Outcome outcome = runScript({});
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  const std::string log = readFile(folder / "log.txt");
  EXPECT_NE(log.find("patina demo -o " + (folder / "out")), std::string::npos) << log;
  EXPECT_EQ(log.find("--tour"), std::string::npos) << log;
}

TEST_F(RunScript, TakesAFileWhereverItStandsAndKeepsItsOptions) {
  const std::string cup = folder.write("cup.obj", "");
  ASSERT_EQ(runScript({"--unit", "cm", cup}).exit, 0);
  const std::string log = readFile(folder / "log.txt");
  EXPECT_EQ(log.find("dinosaur"), std::string::npos) << log;
  EXPECT_NE(log.find("patina info --unit cm " + cup), std::string::npos) << log;
  EXPECT_EQ(runScript({"--unit", "cm", folder / "none.obj"}).exit, 2);
}

TEST_F(RunScript, NamesAMissingToolInOneLine) {
  for (const std::string tool : {"xvfb-run", "ninja", "cmake"}) {
    fs::remove(folder.path() / "tools" / tool);
    const Outcome outcome = runScript({});
    EXPECT_EQ(outcome.exit, 2);
    EXPECT_EQ(outcome.err.find(tool + " is not on the PATH"), 0u) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

} // namespace
} // namespace patina::test
