// Output targets, kinds of files, and removal of partial output at the end of the program.
#include "core/output_target.h"

#include <chrono>
#include <fcntl.h>
#include <fstream>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/descriptor.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_kind.h"
#include "core/staged_folder.h"
#include "core/utf8.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class OutputTargets : public testing::Test {
 protected:
  OutputTargets()
      : folder(fs::path(testing::TempDir()) / ("patina_target_" + std::to_string(getpid()))) {
    fs::create_directories(folder);
  }
  ~OutputTargets() override { fs::remove_all(folder); }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return (folder / name).string();
  }
  fs::path folder;
};

TEST_F(OutputTargets, LinksAreFollowedToTheirTarget) {
  const std::string end = write("end", "");
  fs::create_symlink("end", folder / "one");
  fs::create_symlink(folder / "one", folder / "two");
  EXPECT_EQ(fs::path(outputTarget(folder / "two").path).filename(), "end");
  writeFileAtomically(folder / "two", "bytes");
  EXPECT_TRUE(fs::is_symlink(folder / "two"));
  EXPECT_EQ(readFile(end), "bytes");
  fs::create_symlink("ring", folder / "ring");
  EXPECT_THROW(outputTarget(folder / "ring"), FileError);
  EXPECT_THROW(pathExists(folder / "ring"), FileError);
  EXPECT_FALSE(pathExists(folder / "none"));
}

TEST_F(OutputTargets, StreamsAreThoseOfTheProcess) {
  const int fd = open((folder / "stream").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  ASSERT_EQ(::write(fd, "before ", 7), 7);
  const OutputTarget target = outputTarget("/dev/fd/" + std::to_string(fd));
  EXPECT_TRUE(target.is_stream);
  EXPECT_EQ(target.descriptor, fd);
  writeFileAtomically("/dev/fd/" + std::to_string(fd), "after");
  close(fd);
  EXPECT_EQ(readFile(folder / "stream"), "before after"); // not from the file's start
  EXPECT_EQ(outputTarget("-").descriptor, 1);
  EXPECT_EQ(outputTarget("./-").descriptor, -1);
  EXPECT_THROW(outputTarget("/dev/fd/999"), FileError);
}

TEST_F(OutputTargets, FilesAreRecognisedByTheirContent) {
  using enum FileKind;
  const std::pair<const char*, FileKind> cases[] = {
      {"", empty},
      {"x [m],y [m]\n", table},
      {"a,b\n1,2\n3,4\n", table},
      {"Dear reader, hello\nand goodbye\n", other},
      {" {\"a\": 1}", json},
      {"[1]", json},
      {"ply\nformat ascii 1.0\n", ply},
      {"solid x\nfacet normal", stl},
      {"# made by\n\nv 1 2 3\n", obj},
      {"vase of flowers\n", other},
      {"<?xml?>\n<VTKFile type=\"ImageData\"", image_data},
      {"<?xml?>\n<VTKFile type=\"PolyData\"", poly_data},
      {"\x89PNG\r\n", png},
      {"P5\n4 4\n255\n", pnm},
      {"Patina\n", other},
      {"# t [s] tx ty tz [m] qx qy qz qw\n", poses},
      {"# of a camera\n0.1 1 2 3 0 0 0 1\n", poses},
      {"0.1 1 2 3\n", other},
      {".TH PATINA 1\n", roff},
      {"%YAML:1.0\n", yaml}};
  for (const auto& [text, kind] : cases)
    EXPECT_EQ(kindOf(text, std::string_view(text).size()), kind) << text;
  std::string binary(84 + 50 * 2, '\0');
  binary[80] = 2;
  EXPECT_EQ(kindOf(binary, binary.size()), stl);
  EXPECT_NE(kindOf(binary, binary.size() + 1), stl);
  const std::string mesh = write("g.obj", "v 1 2 3\n");
  EXPECT_NO_THROW(requireSameKind(mesh, obj));
  EXPECT_THROW(requireSameKind(mesh, table), FileError);
  EXPECT_NO_THROW(requireSameKind(folder / "none", table));
}

TEST_F(OutputTargets, UnfinishedOutputIsRemovedIfTheProgramIsTerminated) {
  const pid_t child = fork();
  if (child == 0) {
    const bool earlier = hasCompleteOutput(); // from another test
    AtomicFile file(folder / "half.csv");
    file.append("half");
    StagedFolder staged(folder / "made", "a");
    writeFileAtomically(staged.path() / "a", "a");
    if (hasCompleteOutput() != earlier) _exit(2); // the folder is not complete
    NewFolder kept(folder / "kept", "index");
    makeFolder(folder / "kept");
    kept.keep();
    writeFileAtomically(folder / "whole.csv", "whole");
    if (!hasCompleteOutput()) _exit(3);
    removeUnfinished();
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  std::vector<std::string> names;
  for (const auto& item : fs::recursive_directory_iterator(folder))
    names.push_back(item.path().filename());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"kept", "whole.csv"}));
}

TEST_F(OutputTargets, StagedFolderAppearsCompleteOrNotAtAll) {
  const fs::path out = folder / "out";
  {
    StagedFolder staged(out, "last");
    writeFileAtomically(staged.path() / "a.csv", "x [m],y\n1,2\n");
  }
  EXPECT_FALSE(fs::exists(out)) << "it was not there before";
  fs::create_directory(out);
  write("out/a.csv", "{\"another\": \"kind\"}");
  write("out/last", "old");
  {
    StagedFolder staged(out, "last");
    writeFileAtomically(staged.path() / "a.csv", "x [m],y\n1,2\n");
    writeFileAtomically(staged.path() / "last", "new");
    EXPECT_THROW(staged.commit(), FileError);
  }
  EXPECT_EQ(readFile(out / "last"), "old");
  fs::remove(out / "a.csv");
  fs::remove(out / "last");
  write("out/notes.md", "somebody's own");
  {
    StagedFolder staged(out, "last");
    writeFileAtomically(staged.path() / "notes.md", "ours");
    writeFileAtomically(staged.path() / "last", "new");
    EXPECT_THROW(staged.commit(), FileError) << "of a kind that nobody knows, in a folder not ours";
  }
  EXPECT_EQ(readFile(out / "notes.md"), "somebody's own");
  fs::remove(out / "notes.md");
  {
    StagedFolder staged(out, "last");
    writeFileAtomically(staged.path() / "a.csv", "x [m],y\n1,2\n");
    writeFileAtomically(staged.path() / "last", "new");
    makeFolder(staged.path() / "within");
    writeFileAtomically(staged.path() / "within" / "b", "b");
    staged.commit();
  }
  EXPECT_EQ(readFile(out / "last"), "new");
  EXPECT_EQ(readFile(out / "within" / "b"), "b");
  EXPECT_EQ(std::distance(fs::recursive_directory_iterator(out), {}), 4);
}

TEST_F(OutputTargets, NameWithTheEndingOfAnotherKindIsRejected) {
  EXPECT_THROW(requireSameKind(folder / "new.csv", FileKind::json), FileError);
  EXPECT_THROW(requireSameKind(folder / "new.OBJ", FileKind::table), FileError);
  EXPECT_NO_THROW(requireSameKind(folder / "new.json", FileKind::json));
  EXPECT_NO_THROW(requireSameKind(folder / "new.dat", FileKind::json));
  EXPECT_NO_THROW(requireSameKind(folder / "new", FileKind::table));
}

// A file that cannot be opened because descriptors ran out may be of any kind.
TEST_F(OutputTargets, FileThatCannotBeOpenedIsNotReplaced) {
  const std::string mesh = write("g.obj", "v 1 2 3\n");
  rlimit usual{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &usual), 0);
  std::string said;
  try {
    // The limit is restored before the handler runs: the checks of a sanitizer need a descriptor.
    struct NoDescriptors {
      rlimit usual;
      ~NoDescriptors() { setrlimit(RLIMIT_NOFILE, &usual); }
    };
    const NoDescriptors none{usual};
    const rlimit limit{0, usual.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
    requireSameKind(mesh, FileKind::table);
  } catch (const FileError& error) {
    said = error.what();
  }
  EXPECT_NE(said.find("Too many open files"), std::string::npos) << said;
}

// Two programs write the same new folder; the one that fails must not remove the other's files.
TEST_F(OutputTargets, CompleteOutputOfAnotherWriterInTheSameNewFolderIsKept) {
  const fs::path shared = folder / "shared";
  {
    const NewFolder first(shared, "index");
    makeFolder(shared);
    write("shared/part", "of the first");
    NewFolder second(shared, "index");
    write("shared/index", "the second's");
    second.keep();
  }
  EXPECT_EQ(readFile(shared / "index"), "the second's");
  {
    StagedFolder first(folder / "staged", "last");
    writeFileAtomically(first.path() / "last", "of the first");
    StagedFolder second(folder / "staged", "last");
    writeFileAtomically(second.path() / "last", "the second's");
    second.commit();
  }
  EXPECT_EQ(readFile(folder / "staged" / "last"), "the second's");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "staged"), {}), 1);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 2) << "nothing hidden is left";
}

TEST_F(OutputTargets, IndexFileStaysALink) {
  const fs::path out = folder / "out";
  fs::create_directory(out);
  fs::create_symlink(folder / "elsewhere", out / "last");
  for (const char* text : {"one", "two"}) { // a link to nothing, then to a file
    StagedFolder staged(out, "last");
    writeFileAtomically(staged.path() / "last", text);
    staged.commit();
    EXPECT_TRUE(fs::is_symlink(out / "last"));
    EXPECT_EQ(readFile(out / "last"), text);
    EXPECT_EQ(readFile(folder / "elsewhere"), text);
  }
}

class Pipes : public OutputTargets {
 protected:
  Pipes() : pipe(folder / "pipe") { mkfifo(pipe.c_str(), 0600); }
  fs::path pipe;
  static constexpr std::chrono::milliseconds kShort{60}, kLong{20000};
};

TEST_F(Pipes, FailAtOnceWithoutAWriter) {
  EXPECT_THROW(openToRead(pipe, kShort), FileError);
  // If the pipe's owner may not write it, no process can release a waiting reader.
  ASSERT_EQ(chmod(pipe.c_str(), 0444), 0);
  ASSERT_EQ(chmod(folder.c_str(), 0755), 0);
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);
    if (geteuid() == 0 && setuid(65534) != 0) _exit(3);
    try {
      openToRead(pipe, kShort);
    } catch (const FileError&) {
      _exit(0);
    }
    _exit(1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

TEST_F(Pipes, AreReadOnceAWriterOpensThemAndMayBeSilentFirst) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);
    Descriptor writer(openRetrying(pipe.c_str(), O_WRONLY)); // waits for the reader
    usleep(100000);                                          // silent at first
    _exit(writeAll(writer.get(), "late") ? 0 : 1);
  }
  const Descriptor reader(openToRead(pipe, kLong));
  EXPECT_EQ(readAll(reader.get(), "pipe"), "late");
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

TEST_F(Pipes, EndIfTheWriterCloses) {
  const Descriptor held(openRetrying(pipe.c_str(), O_RDONLY | O_NONBLOCK));
  Descriptor writer(openRetrying(pipe.c_str(), O_WRONLY));
  ASSERT_TRUE(writeAll(writer.get(), "all"));
  writer.close();
  const Descriptor reader(openToRead(pipe, kLong)); // the bytes remain, the writer is gone
  EXPECT_EQ(readAll(reader.get(), "pipe"), "all");
}

TEST(Utf8, AcceptsAnyLanguageAndNoInvalidBytes) {
  for (const char* good : {"", "cup", "Gef\xc3\xa4\xc3\x9f", "\xe6\x9d\xaf", "\xf0\x9f\x8f\xba"})
    EXPECT_TRUE(isUtf8(good)) << good;
  for (const char* bad : {"\xc3", "\xa4", "\xc0\xaf", "\xed\xa0\x80", "\xf5\x80\x80\x80",
                          "\xe6\x9d", "a\nb", "\x7f", "\xc2\x85", "\xe0\x80\xaf"})
    EXPECT_FALSE(isUtf8(bad)) << bad;
}

} // namespace
} // namespace patina
