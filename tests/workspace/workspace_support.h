// A folder and its files, for the tests of the workspace.
#pragma once

#include <filesystem>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/error.h"
#include "core/file.h"
#include "support/fresh_folder.h"
#include "support/painted_scene.h"
#include "workspace/workspace.h"

namespace patina {

inline void replaceIn(const std::filesystem::path& path, const std::string& from,
                      const std::string& to) {
  std::string text = readFile(path);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  writeFileAtomically(path, text);
}

// Returns the line of a thrown FileError; "" if none is thrown.
template <typename Work> std::string errorOf(const Work& work) {
  try {
    work();
  } catch (const FileError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    return line;
  }
  return "";
}
inline bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// The folder is in memory if the system offers that: these tests flush thousands of times.
inline std::filesystem::path fastFolder() {
  return ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : testing::TempDir();
}

// Makes a folder for each test and removes it afterwards.
class WorkspaceTest : public testing::Test {
 protected:
  explicit WorkspaceTest(const std::filesystem::path& base = fastFolder())
      : root(test::freshFolder("workspace", base)), folder(root / "scene") {}
  ~WorkspaceTest() override { std::filesystem::remove_all(root); }

  std::size_t filesIn(const std::string& part) const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder / part), {}));
  }
  std::filesystem::path root;
  std::filesystem::path folder;
};

} // namespace patina
