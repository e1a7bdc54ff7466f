#include "core/sha256.h"

#include "core/error.h"
#include "core/file.h"
#include "support/fresh_folder.h"

namespace patina {
namespace {

// FIPS 180-4 examples.
TEST(Sha256, MatchesTheExamplesOfTheStandard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

// One million letters a are the standard's third example; a file is read in parts of a mebibyte.
// RFC 1321, A.5.
TEST(Md5, MatchesTheStandard) {
  EXPECT_EQ(md5(""), "d41d8cd98f00b204e9800998ecf8427e");
  EXPECT_EQ(md5("message digest"), "f96b697d7cb7938d525a2f31aaf161d0");
}

TEST(Sha256, FileHashEqualsTheHashOfItsBytes) {
  const std::filesystem::path folder = test::freshFolder("sha256"), path = folder / "file";
  writeFileAtomically(path, std::string(1000000, 'a'));
  EXPECT_EQ(sha256OfFile(path), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  const std::string larger(3 << 20, 'b');
  writeFileAtomically(path, larger);
  EXPECT_EQ(sha256OfFile(path), sha256(larger));
  EXPECT_THROW(sha256OfFile(folder / "missing"), FileError);
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace patina
