// app/run.sh with replacements of the tools that it calls: the object that it chooses, the words
// that it refuses.
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
    for (const std::string name : {"app/run.sh", "app/packages.sh", "app/build.sh"})
      fs::copy_file(sourceFolder() / name, folder.path() / name);
    const std::string log = "echo \"${0##*/} $*\" >>'" + (folder / "log.txt") + "'\n";
    for (const char* name :
         {"build/bin/patina", "build/bin/patina-gui", "tools/ninja", "tools/c++"})
      program(name, log);
    program("tools/cmake", log);
    program("tools/xvfb-run", "shift 3\nexec \"$@\"\n");
    for (const char* name : {"dirname", "mkdir", "cat", "nproc", "awk", "sh", "df", "grep", "rm",
                             "tail", "tee", "touch"})
      fs::create_symlink(fs::path("/usr/bin") / name, folder.path() / "tools" / name);
  }
  void program(const std::string& name, const std::string& body) const {
    fs::permissions(folder.write(name, "#!/bin/sh\n" + body), fs::perms::owner_all);
  }
  Outcome runScript(const std::vector<std::string>& words,
                    const std::vector<std::string>& environment = {}) const {
    std::vector<std::string> all = {"-i",
                                    "PATH=" + (folder / "tools"),
                                    "PATINA_INSTALL=no",
                                    "PATINA_OUT=" + (folder / "out"),
                                    "/bin/sh",
                                    folder / "app/run.sh"};
    all.insert(all.end() - 2, environment.begin(), environment.end());
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
  EXPECT_EQ(log.find("--unit"), std::string::npos) << log; // the file is in millimetres
}

TEST_F(RunScript, TakesAScanToContactWithoutAnArgument) {
  const Outcome outcome = runScript({});
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  const std::string log = readFile(folder / "log.txt");
  EXPECT_NE(log.find("patina demo -o " + (folder / "out")), std::string::npos) << log;
  EXPECT_EQ(log.find("patina-gui"), std::string::npos) << log;
}

TEST_F(RunScript, BuildsTheWindowIfOneOpens) {
  const std::string cup = folder.write("cup.obj", "");
  ASSERT_EQ(runScript({}).exit, 0);
  EXPECT_EQ(readFile(folder / "log.txt").find("patina-gui"), std::string::npos);
  ASSERT_EQ(runScript({}, {"DISPLAY=:7"}).exit, 0);
  EXPECT_NE(readFile(folder / "log.txt").find("--target patina patina-gui"), std::string::npos);
  fs::remove(folder.path() / "log.txt");
  ASSERT_EQ(runScript({cup}).exit, 0);
  EXPECT_EQ(readFile(folder / "log.txt").find("patina-gui"), std::string::npos);
}

TEST_F(RunScript, AcceptsAFileAtAnyPositionAndKeepsItsOptions) {
  const std::string cup = folder.write("cup.obj", "");
  ASSERT_EQ(runScript({"--unit", "cm", cup}).exit, 0);
  const std::string log = readFile(folder / "log.txt");
  EXPECT_EQ(log.find("dinosaur"), std::string::npos) << log;
  EXPECT_NE(log.find("patina info --unit cm " + cup), std::string::npos) << log;
  EXPECT_EQ(runScript({"--unit", "cm", folder / "none.obj"}).exit, 2);
}

TEST_F(RunScript, NamesAMissingToolInOneLine) {
  for (const std::string tool : {"xvfb-run", "ninja", "cmake", "c++"}) {
    fs::remove(folder.path() / "tools" / tool);
    const Outcome outcome = runScript({});
    EXPECT_EQ(outcome.exit, 2);
    EXPECT_EQ(outcome.err.find(tool + " is not on the PATH"), 0u) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

TEST_F(RunScript, LeavesTheTestsOutOfTheFirstBuild) {
  ASSERT_EQ(runScript({}).exit, 0);
  const std::string log = readFile(folder / "log.txt");
  EXPECT_NE(log.find("-DBUILD_TESTING=OFF"), std::string::npos) << log;
}

TEST_F(RunScript, BuildsInTheFolderThatTheEnvironmentNames) {
  fs::create_directories(folder.path() / "elsewhere/bin");
  for (const char* name : {"patina", "patina-gui"})
    fs::rename(folder.path() / "build/bin" / name, folder.path() / "elsewhere/bin" / name);
  const Outcome outcome = runScript({}, {"PATINA_BUILD=" + (folder / "elsewhere")});
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_NE(readFile(folder / "log.txt").find("-B " + (folder / "elsewhere")), std::string::npos);
}

// A tool that fails with `said`, in place of cmake's configuration or of its build.
struct Failure {
  const char* step;
  const char* said;
  const char* expected;
};

TEST_F(RunScript, GivesCauseAndRemedyOfAFailedStepInOneLine) {
  const std::vector<Failure> failures{
      {"-S", "Missing: libvtk9-qt-dev. Run: apt-get install libvtk9-qt-dev", "Missing: libvtk9"},
      {"-S", "CMake Error: No space left on device", "is full"},
      {"--build", "cc1plus: fatal error: No space left on device", "is full"},
      {"--build", "c++: fatal error: Killed signal terminated program cc1plus", "PATINA_JOBS=1"},
      {"--build", "virtual memory exhausted: Cannot allocate memory", "PATINA_JOBS=1"}};
  for (const Failure& failure : failures) {
    program("tools/cmake", std::string("case \"$*\" in *") + failure.step + "\\ *) echo '" +
                               failure.said + "'; exit 1 ;; esac\n");
    const Outcome outcome = runScript({});
    EXPECT_EQ(outcome.exit, 2) << failure.said;
    // The last line has the cause, after the output of the build itself.
    const std::string err = outcome.err.substr(0, outcome.err.size() - 1);
    const std::string last = err.substr(err.rfind('\n') + 1);
    EXPECT_NE(last.find(failure.expected), std::string::npos)
        << failure.said << ": " << outcome.err;
  }
}

TEST_F(RunScript, RefusesAnUnwritableFolderFirst) {
  folder.write("file", "");
  for (const char* variable : {"PATINA_BUILD", "PATINA_OUT"}) {
    const Outcome outcome = runScript({}, {std::string(variable) + "=" + (folder / "file/below")});
    EXPECT_EQ(outcome.exit, 2);
    EXPECT_NE(outcome.err.find(folder / "file cannot be written to"), std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find(variable), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder / "log.txt"));
  }
}

} // namespace
} // namespace patina::test
