#include "geometry/io/commented_file.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file.h"
#include "support/fresh_folder.h"

namespace patina {
namespace {

TEST(CommentedFile, IsReadWithoutTheWordsOfItsComments) {
  const std::filesystem::path folder = test::freshFolder("commented");
  const auto read = [&](const std::string& text) {
    writeFileAtomically(folder / "a.txt", text);
    return readCommented(folder / "a.txt");
  };
  const std::string words(100000, 'x');
  EXPECT_EQ(read(""), "");
  EXPECT_EQ(read("v 1\nf 2"), "v 1\nf 2");
  EXPECT_EQ(read("# one\nv 1 # two\n \t# three\r\n#\n##four"), "#\nv 1 # two\n \t#\r\n#\n#");
  EXPECT_EQ(read("#old Mac\rv 1\r#more\rf 2"), "#\rv 1\r#\rf 2");
  EXPECT_EQ(read("v 1\n#" + words + "\nf 2\n"), "v 1\n#\nf 2\n");
  EXPECT_EQ(read("v 1 #" + words + "\nf 2\n"), "v 1 #" + words.substr(0, 4095) + "\nf 2\n");
  // Ends of the parts in which a file is read do not matter.
  for (std::size_t before = 65530; before < 65540; ++before) {
    const std::string line(before, 'v');
    EXPECT_EQ(read(line + "\n#a\n#b\nf"), line + "\n#\n#\nf");
    EXPECT_EQ(read(line + "#a\n#b\nf"), line + "#a\n#\nf");
  }
  EXPECT_THROW(readCommented(folder), FileError);
  EXPECT_THROW(readCommented(folder / "missing"), FileError);
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace patina
