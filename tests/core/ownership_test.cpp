// Links and folders of other users. Root gives its files away; another user, who cannot, is asked
// about in place of the caller.
#include "core/ownership.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sys/stat.h>

#include "core/error.h"
#include "core/file.h"
#include "core/output_target.h"
#include "support/fresh_folder.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class Ownership : public testing::Test {
 protected:
  Ownership() : folder(test::freshFolder("owned")) {
    if (is_root) {
      EXPECT_EQ(chmod(folder.c_str(), 01777), 0);
    }
  }
  ~Ownership() override { fs::remove_all(folder); }
  // A link that does not belong to `asked`, in a sticky folder that does not belong to its owner.
  fs::path foreignLink(const fs::path& to) {
    const fs::path link =
        (is_root ? folder : folder.parent_path()) / (folder.filename().string() + "_link");
    fs::create_symlink(to, link);
    if (is_root) {
      EXPECT_EQ(lchown(link.c_str(), kOther, kOther), 0);
    }
    return link;
  }
  static std::string causeFor(const fs::path& file, uid_t user) {
    try {
      trustedFile(file, user);
      return {};
    } catch (const FileError& error) {
      return error.what();
    }
  }

  static constexpr uid_t kOther = 65533;
  const bool is_root = geteuid() == 0;
  const uid_t owner = geteuid(), asked = is_root ? 0 : kOther;
  const fs::path folder;
};

TEST_F(Ownership, LinkOfAnotherUserInAStickyFolderIsForeign) {
  const fs::path link = foreignLink(folder / "end");
  EXPECT_TRUE(isForeignLink(link, asked));
  EXPECT_TRUE(isForeignLink(link / "", asked)) << "a slash follows it";
  EXPECT_FALSE(isForeignLink(link, is_root ? kOther : owner)) << "of its own user";
  EXPECT_FALSE(isForeignLink(folder / "none", asked));
  if (is_root) {
    EXPECT_THROW(outputTarget(link), FileError);
    EXPECT_THROW(makeFolder(link), FileError);
    fs::create_symlink(link, folder / "own"); // the second link of two counts as well
    EXPECT_THROW(writeFileAtomically(folder / "own", "bytes"), FileError);
    EXPECT_FALSE(fs::exists(folder / "end"));
    ASSERT_EQ(chmod(folder.c_str(), 0777), 0);
    EXPECT_FALSE(isForeignLink(link, asked)) << "the kernel asks for both bits";
    ASSERT_EQ(chmod(folder.c_str(), 01775), 0);
    EXPECT_FALSE(isForeignLink(link, asked));
    ASSERT_EQ(chmod(folder.c_str(), 01777), 0);
    ASSERT_EQ(lchown(link.c_str(), owner, owner), 0);
    EXPECT_FALSE(isForeignLink(link, kOther)) << "of the folder's owner";
  }
  fs::remove(link);
}

TEST_F(Ownership, PrivateFolderIsOfTheUserAndClosedToOthers) {
  const fs::path own = folder / "own";
  ASSERT_EQ(mkdir(own.c_str(), 0700), 0);
  EXPECT_TRUE(isPrivateFolder(own));
  EXPECT_FALSE(isPrivateFolder(own, owner + 1));
  fs::create_directory_symlink(own, folder / "link");
  EXPECT_FALSE(isPrivateFolder(folder / "link"));
  ASSERT_EQ(chmod(own.c_str(), 0750), 0);
  EXPECT_FALSE(isPrivateFolder(own));
  EXPECT_FALSE(isPrivateFolder(folder / "none"));
}

TEST_F(Ownership, RuntimeFolderIsPrivateOrNone) {
  const auto setFolders = [&](const fs::path& given) {
    ASSERT_EQ(setenv("XDG_RUNTIME_DIR", given.c_str(), 1), 0);
    ASSERT_EQ(setenv("TMPDIR", folder.c_str(), 1), 0);
  };
  const fs::path own = folder / "own", open = folder / "open",
                 made = folder / ("patina-runtime-" + std::to_string(owner));
  ASSERT_EQ(mkdir(own.c_str(), 0700) + mkdir(open.c_str(), 0755), 0);
  setFolders(own);
  EXPECT_EQ(runtimeFolder().path, own);
  EXPECT_EQ(runtimeFolder().problem, "");
  EXPECT_FALSE(fs::exists(made));
  setFolders(open);
  EXPECT_EQ(runtimeFolder().path, made);
  EXPECT_TRUE(runtimeFolder().problem.starts_with("XDG_RUNTIME_DIR=" + open.string()));
  setFolders("");
  EXPECT_EQ(runtimeFolder().path, made);
  EXPECT_EQ(runtimeFolder().problem, "");
  ASSERT_EQ(chmod(made.c_str(), 0777), 0);
  EXPECT_EQ(runtimeFolder().path, "");
  EXPECT_TRUE(runtimeFolder().problem.starts_with(made.string()));
  fs::remove(made);
  fs::create_directory_symlink(own, made);
  EXPECT_EQ(runtimeFolder().path, "") << "a link";
  if (is_root) {
    ASSERT_EQ(chown(own.c_str(), kOther, kOther), 0);
    setFolders(own);
    EXPECT_EQ(runtimeFolder().path, "");
  }
  unsetenv("TMPDIR");
  unsetenv("XDG_RUNTIME_DIR");
}

TEST_F(Ownership, CodeIsTrustedIfOnlyTheUserAndRootCanChangeIt) {
  const uid_t user = is_root ? kOther : owner;
  const fs::path place = folder / "code", file = place / "plug.so";
  fs::create_directory(place);
  writeFileAtomically(file, "code");
  fs::create_symlink(file, place / "link.so");
  const auto give = [&](const fs::path& to, uid_t whose, mode_t mode) {
    ASSERT_EQ(chmod(to.c_str(), mode), 0);
    if (is_root) {
      ASSERT_EQ(chown(to.c_str(), whose, whose), 0);
    }
  };
  give(place, user, 0755);
  give(file, user, 0755);
  EXPECT_EQ(causeFor(file, user), "");
  EXPECT_EQ(trustedFile(place / "link.so", user), fs::canonical(file));
  EXPECT_NE(causeFor(file, user + 1).find("neither to you nor to root"), std::string::npos);
  EXPECT_NE(causeFor(file, 0).find("root"), std::string::npos) << "no system folder";
  give(file, user, 0757);
  EXPECT_NE(causeFor(file, user).find("others may write into"), std::string::npos);
  give(file, user, 0755);
  give(place, user, 01777); // sticky or not
  EXPECT_NE(causeFor(file, user).find("others may write into"), std::string::npos);
  EXPECT_NE(causeFor(place / "link.so", user), "");
  give(place, user, 0755);
  fs::create_directory(place / "folder");
  EXPECT_NE(causeFor(place / "folder", user).find("is no plain file"), std::string::npos);
  EXPECT_NE(causeFor(place / "none", user).find("cannot be read"), std::string::npos);
  if (is_root) { // a group of others; the user's own one is not
    ASSERT_EQ(chmod(file.c_str(), 0775), 0);
    EXPECT_EQ(causeFor(file, user), "");
    ASSERT_EQ(chown(file.c_str(), user, 0), 0);
    EXPECT_NE(causeFor(file, user), "");
    give(file, 0, 0755);
    give(place, 0, 0755);
    EXPECT_EQ(causeFor(file, user), "") << "of root";
    EXPECT_NE(causeFor(file, 0), "") << "everybody's folder is above it";
  }
}

TEST_F(Ownership, RootRunsCodeOfSystemFolders) {
  EXPECT_EQ(causeFor("/bin/sh", 0), "");
  EXPECT_EQ(causeFor("/bin/sh", owner), "");
}

} // namespace
} // namespace patina
