#include "core/file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "core/error.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class FileTest : public testing::Test {
 protected:
  FileTest() : folder(fs::path(testing::TempDir()) / ("patina_file_" + std::to_string(getpid()))) {
    fs::create_directories(folder);
  }
  ~FileTest() override { fs::remove_all(folder); }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
  }
  fs::path folder;
};

TEST_F(FileTest, BytesReadBack) {
  std::string bytes;
  for (int i = 0; i < 300000; ++i) bytes += static_cast<char>(i * 7);
  writeFileAtomically(folder / "a.bin", bytes);
  EXPECT_EQ(readFile(folder / "a.bin"), bytes);
  writeFileAtomically(folder / "a.bin", "");
  EXPECT_EQ(readFile(folder / "a.bin"), "");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(FileTest, ReadsFilesOfUnknownSize) {
  EXPECT_NE(readFile("/proc/self/status").find("Pid:"), std::string::npos);
}

TEST_F(FileTest, ErrorsNameThePath) {
  try {
    readFile(folder / "missing");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("missing: cannot be opened"), std::string::npos);
    EXPECT_EQ(error.line(), 0u);
  }
  EXPECT_THROW(readFile(folder), FileError);
  EXPECT_THROW(writeFileAtomically(folder / "no" / "such" / "folder", "x"), FileError);
}

TEST_F(FileTest, KeepsThePermissionsOfAReplacedFile) {
  writeFileAtomically(folder / "secret", "old");
  ::chmod((folder / "secret").c_str(), 0600);
  writeFileAtomically(folder / "secret", "new");
  struct stat info {};
  ::stat((folder / "secret").c_str(), &info);
  EXPECT_EQ(info.st_mode & 0777, 0600u);
}

TEST_F(FileTest, FullDiskKeepsTheOldFileAndLeavesNoTemporaryFile) {
  const fs::path path = folder / "data";
  writeFileAtomically(path, "old");
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ,
                SIG_IGN); // a write then fails as on a full disk: short, then an error
    const rlimit limit{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      writeFileAtomically(path, std::string(5000, 'n'));
    } catch (const FileError&) {
      _exit(7);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_EQ(readFile(path), "old");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(FileTest, CreatesMissingFolders) {
  makeFolder(folder / "a" / "b" / "c/");
  EXPECT_TRUE(fs::is_directory(folder / "a" / "b" / "c"));
  makeFolder(folder / "a");
  writeFileAtomically(folder / "file", "x");
  EXPECT_THROW(makeFolder(folder / "file"), FileError);
  EXPECT_THROW(makeFolder(folder / "file" / "in"), FileError);
  try { // the kernel allows no folder here, even for root
    makeFolder("/sys/patina");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
}

TEST_F(FileTest, RecognisesItsTemporaryFiles) {
  EXPECT_TRUE(isTemporaryFor("a.bin", ".a.bin.123-4.tmp"));
  for (const char* other : {"a.bin", ".a.bin.tmp", ".b.bin.123-4.tmp", ".a.bin.x.tmp", ".a.bin."})
    EXPECT_FALSE(isTemporaryFor("a.bin", other)) << other;
}

TEST_F(FileTest, CannotReplaceAFolder) {
  fs::create_directories(folder / "sub" / "inner");
  EXPECT_THROW(writeFileAtomically(folder / "sub", "x"), FileError);
  EXPECT_EQ(entries(), 1u);
}

} // namespace
} // namespace patina
