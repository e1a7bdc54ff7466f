// The version text of the program, and the script that finds the commit.
#include "core/version.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>
#include <unistd.h>

#include "core/file.h"
#include "support/fresh_folder.h"
#include "support/places.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

TEST(Version, NamesTheReleaseAndTheCommit) {
  EXPECT_EQ(programVersion(), "0.2.0");
  EXPECT_FALSE(programCommit().empty());
  const bool known = programCommit() != "unknown";
  EXPECT_EQ(versionText(), known ? "0.2.0 (commit " + std::string(programCommit()) + ")"
                                 : "0.2.0 (unknown commit)");
  const Json json = programDescription();
  EXPECT_EQ(json.at("version").asString(), programVersion());
  EXPECT_EQ(json.at("commit").asString(), programCommit());
}

// A source folder for version.cmake.
class CommitOf : public testing::Test {
 protected:
  ~CommitOf() override { fs::remove_all(folder_); }
  void shell(const std::string& line) const {
    const std::string all = "cd '" + source().string() + "' && (" + line + ") >/dev/null 2>&1";
    ASSERT_EQ(std::system(all.c_str()), 0) << line;
  }
  void commitAFile() const {
    shell("git init -q && echo one > file && git add file && git -c user.name=a "
          "-c user.email=a commit -q -m one");
  }
  // Returns the header written by the script.
  std::string header(const std::string& options = "") const {
    const std::string script = test::sourceFolder() / "modules/core/version.cmake";
    shell("cmake -D 'SOURCE=" + source().string() + "' -D VERSION=1.2.3 -D 'OUTPUT=" +
          output().string() + "' " + options + " -P '" + script + "'");
    return readFile(output());
  }
  static std::string saying(const std::string& commit) {
    return "#define PATINA_VERSION \"1.2.3\"\n#define PATINA_COMMIT \"" + commit + "\"\n";
  }
  fs::path source() const { return folder_ / "a source"; }
  fs::path output() const { return folder_ / "built_from.h"; }

 private:
  void SetUp() override { fs::create_directory(source()); }
  fs::path folder_ = test::freshFolder("version");
};

TEST_F(CommitOf, FolderWithoutGitIsUnknown) {
  EXPECT_EQ(header(), saying("unknown"));
}

TEST_F(CommitOf, RepositoryHasItsHeadWithAMarkForEdits) {
  commitAFile();
  const std::string clean = header();
  EXPECT_TRUE(std::regex_search(clean, std::regex("COMMIT \"[0-9a-f]{12}\"\n"))) << clean;
  const auto written = fs::last_write_time(output());
  EXPECT_EQ(header(), clean);
  EXPECT_EQ(fs::last_write_time(output()), written); // nothing is compiled again
  shell("echo two > file");
  EXPECT_TRUE(std::regex_search(header(), std::regex("[0-9a-f]{12}-dirty\"\n")));
}

TEST_F(CommitOf, WorktreeHasItsOwnHead) {
  shell(
      "mkdir ../main && cd ../main && git init -q && echo one > file && git add file && git -c "
      "user.name=a -c user.email=a commit -q -m one && git worktree add -q --detach '../a source'");
  const std::string before = header();
  EXPECT_TRUE(std::regex_search(before, std::regex("COMMIT \"[0-9a-f]{12}\"\n"))) << before;
  shell("echo two > file && git -c user.name=a -c user.email=a commit -q -a -m two");
  EXPECT_NE(header(), before);
}

TEST_F(CommitOf, RepositoryOfAnotherUserIsRead) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give a folder away";
  commitAFile();
  const std::string own = header();
  shell("chown -R 65534:65534 .");
  EXPECT_EQ(header(), own);
}

TEST_F(CommitOf, CommitOfACloneIsReadWithoutGit) {
  commitAFile();
  const std::string with_git = header();
  const std::string without = "-D GIT=/nowhere/git";
  EXPECT_EQ(header(without), with_git);
  shell("git pack-refs --all");
  EXPECT_EQ(header(without), with_git);
  shell("git checkout -q --detach");
  EXPECT_EQ(header(without), with_git);
}

TEST_F(CommitOf, ArchiveHasTheCommitWrittenByGit) {
  fs::copy_file(test::sourceFolder() / ".gitattributes", source() / ".gitattributes");
  // A checkout may have lost its .git.
  writeFileAtomically(source() / ".git_archival.txt", "commit: $Format:%H$\n");
  EXPECT_EQ(header(), saying("unknown"));
  shell("git init -q && git add . && git -c user.name=a -c user.email=a commit -q -m one");
  const std::string of_repository = header();
  shell("git archive -o ../archive.tar HEAD && rm -rf .git .git_archival.txt && tar xf "
        "../archive.tar");
  EXPECT_EQ(header(), of_repository);
}

} // namespace
} // namespace patina
