#include "pictures/picture_file.h"
#include "workspace/paint_files.h"

#include <cstdlib>
#include <fstream>
#include <sys/wait.h>

#include "support/places.h"
#include "support/sanitized.h"
#include "workspace/workspace_support.h"

namespace patina {
namespace {

// libpng jumps over the destructors of its callers when a file is broken; these few bytes are not
// our leak.
using test::LeaksOfOthers;

class ImageFileTest : public WorkspaceTest {};

Picture somePicture(int width, int height, int channels) {
  Picture picture{width, height, channels, {}};
  for (int k = 0; k < width * height * channels; ++k)
    picture.texel.push_back(static_cast<float>(k % 65536) / 65535.0f);
  return picture;
}

bool loaded(const char* library) {
  return says(readFile("/proc/self/maps"), library);
}

TEST_F(ImageFileTest, Png16ReadsBackBitForBit) {
  for (const int channels : {1, 2, 3, 4}) {
    const Picture picture = somePicture(301, 173, channels);
    writePicture(root / "p.png", picture);
    const Picture read = readPicture(root / "p.png");
    ASSERT_EQ(read.channels, channels);
    ASSERT_EQ(read.width, 301);
    ASSERT_EQ(read.height, 173);
    for (std::size_t k = 0; k < picture.texel.size(); ++k)
      ASSERT_EQ(std::lround(read.texel[k] * 65535), std::lround(picture.texel[k] * 65535)) << k;
  }
}

// CRC-32 of a PNG's chunk.
std::uint32_t checkOf(std::string_view bytes) {
  std::uint32_t sum = 0xffffffffU;
  for (const char c : bytes) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (sum & 1 ? 0xedb88320U : 0U);
  }
  return ~sum;
}

void putBigEndian(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (int k = 0; k < 4; ++k)
    bytes[at + static_cast<std::size_t>(k)] = static_cast<char>(value >> (24 - 8 * k));
}

TEST_F(ImageFileTest, PngTooShortForItsSizeIsRefusedWithoutMemoryForIt) {
  writePicture(root / "p.png", somePicture(8, 8, 1));
  std::string bytes = readFile(root / "p.png");
  constexpr std::size_t kHeader = 12; // here begins the first chunk: name, width, height, 5 bytes
  putBigEndian(bytes, kHeader + 4, 16384);
  putBigEndian(bytes, kHeader + 8, 16384);
  putBigEndian(bytes, kHeader + 17, checkOf(std::string_view(bytes).substr(kHeader, 17)));
  std::ofstream(root / "p.png", std::ios::binary) << bytes;
  EXPECT_TRUE(says(errorOf([&] { readPicture(root / "p.png"); }), "cannot hold 16384 x 16384"));
}

TEST_F(ImageFileTest, PngClampsValuesOutOfRange) {
  writePicture(root / "p.png", {2, 2, 1, {-3, 7, 0.5f, std::nanf("")}});
  const Picture read = readPicture(root / "p.png");
  EXPECT_EQ(read.texel[0], 0);
  EXPECT_EQ(read.texel[1], 1);
  EXPECT_NEAR(read.texel[2], 0.5, 1.0 / 65535);
  EXPECT_EQ(read.texel[3], 0);
}

TEST_F(ImageFileTest, ExrPicturesReadBackBitForBit) {
  for (const int channels : {1, 2, 3, 4}) {
    Picture picture = somePicture(70, 33, channels);
    picture.texel[0] = -1e30f;
    picture.texel[1] = 1e-42f; // denormal
    picture.texel[2] = -0.0f;
    picture.texel[3] = 12345.678f;
    writePicture(root / "p.exr", picture);
    const Picture read = readPicture(root / "p.exr");
    ASSERT_EQ(read.channels, channels);
    ASSERT_EQ(read.texel.size(), picture.texel.size());
    ASSERT_EQ(std::memcmp(read.texel.data(), picture.texel.data(), 4 * read.texel.size()), 0);
  }
}

// Row 0 at the bottom: a portable grey map lists its rows from the top, so it is the oracle.
TEST_F(ImageFileTest, RowsAreCountedFromTheBottom) {
  std::ofstream(root / "p.pgm") << "P2 1 3 255\n10\n20\n30\n";
  const Picture picture = readPicture(root / "p.pgm");
  ASSERT_EQ(picture.texel.size(), 3u);
  EXPECT_FLOAT_EQ(picture.texel[0], 30 / 255.0f);
  EXPECT_FLOAT_EQ(picture.texel[2], 10 / 255.0f);
}

TEST_F(ImageFileTest, PaintedImagesReadBackBitForBit) {
  for (const int channels : {1, kColorChannels}) {
    const TiledImage image = paintedImage(160, 96, channels, 7);
    const std::string bytes = exrBytes(image);
    EXPECT_EQ(exrBytes(image), bytes); // the name of a file is its hash
    const TiledImage read = parseExr(bytes, channels, "image");
    EXPECT_TRUE(same(image, read));
    EXPECT_EQ(read.bytes(), image.bytes()); // unpainted tiles are not stored
    EXPECT_TRUE(
        says(errorOf([&] { parseExr(bytes, 5 - channels, "image"); }), "is not a painted image"));
  }
  // The channels must keep their order.
  TiledImage image(64, 64, 4);
  for (int c = 0; c < 4; ++c) image.writable(0)[c] = static_cast<float>(c + 1);
  const TiledImage read = parseExr(exrBytes(image), 4, "image");
  for (int c = 0; c < 4; ++c) EXPECT_EQ(read.at(0, 0, c), static_cast<float>(c + 1));
}

TEST_F(ImageFileTest, ImagesWithNanAreNotStored) {
  TiledImage image(64, 64, 1);
  image.writable(3)[5] = std::nanf("");
  EXPECT_THROW(exrBytes(image), Error);
}

// Every prefix, and many single changes, of each format give an error or a picture, never a crash.
TEST_F(ImageFileTest, BrokenFilesAreErrors) {
  writePicture(root / "a.png", somePicture(40, 30, 3));
  writePicture(root / "b.exr", somePicture(40, 30, 3));
  const LeaksOfOthers leaks;
  std::mt19937 random(5);
  for (const std::string name : {"a.png", "b.exr"}) {
    const std::string bytes = readFile(root / name);
    const std::filesystem::path path = root / ("broken-" + name);
    for (std::size_t size = 0; size + 20 < bytes.size(); size += bytes.size() / 40) {
      std::ofstream(path) << bytes.substr(0, size);
      const std::string error = errorOf([&] { readPicture(path); });
      ASSERT_TRUE(says(error, path.string() + ": ")) << name << " cut at " << size << ": " << error;
    }
    for (int round = 0; round < 60; ++round) {
      std::string changed = bytes;
      for (int k = 0; k < 3; ++k) changed[random() % changed.size()] = static_cast<char>(random());
      std::ofstream(path) << changed;
      errorOf([&] { readPicture(path); }); // any message
    }
  }
  std::ofstream(root / "empty.png").close();
  EXPECT_TRUE(says(errorOf([&] { readPicture(root / "empty.png"); }), "the file is empty"));
  EXPECT_TRUE(says(errorOf([&] { readPicture(root / "none.png"); }), "does not exist"));
  EXPECT_TRUE(says(errorOf([&] { readPicture(root); }), "is not a file"));
  std::ofstream(root / "text.png") << "no picture\n";
  EXPECT_TRUE(says(errorOf([&] { readPicture(root / "text.png"); }), "cannot be read"));
  EXPECT_TRUE(says(errorOf([&] { parseExr("", 1, "i"); }), "i: the file is empty"));
  EXPECT_TRUE(says(errorOf([&] { parseExr("not one", 1, "i"); }), "i: cannot be read as an EXR"));
}

// A header may claim any size.
TEST_F(ImageFileTest, RefusesHugeSizesBeforeAllocation) {
  for (const char* size : {"100000 1", "1 100000", "16384 16384"}) {
    std::ofstream(root / "p.ppm") << "P6 " << size << " 65535\nabc";
    const std::string error = errorOf([&] { readPicture(root / "p.ppm"); });
    EXPECT_TRUE(says(error, "at most 16384") || says(error, "larger than the memory")) << error;
  }
  writePicture(root / "w.exr", somePicture(40, 30, 1));
  std::string bytes = readFile(root / "w.exr");
  for (const char* window : {"dataWindow", "displayWindow"}) {
    const std::size_t at = bytes.find(window) + std::string(window).size() + 1 + 6 + 4;
    const std::int32_t far[4] = {-2000000000, -2000000000, 2000000000, 2000000000};
    std::memcpy(bytes.data() + at, far, sizeof far);
  }
  std::ofstream(root / "w.exr") << bytes;
  EXPECT_NE(errorOf([&] { readPicture(root / "w.exr"); }), "");
}

TEST_F(ImageFileTest, RefusesOtherExtensionsForWriting) {
  EXPECT_TRUE(says(errorOf([&] { writePicture(root / "p.gif", somePicture(2, 2, 1)); }),
                   "must end in .png or .exr"));
}

// A program without its libraries names the missing one and its place.
TEST_F(ImageFileTest, NamesAMissingLibrary) {
  writePicture(root / "p.png", somePicture(3, 2, 1));
  std::filesystem::create_directories(root / "bin");
  const std::string alone = root / "bin" / "program", err = root / "err";
  std::filesystem::copy_file(test::programFolder() / "workspace_child", alone);
  const std::string words = alone + " picture " + (root / "p.png").string() + " 2>" + err;
  EXPECT_EQ(WEXITSTATUS(std::system(words.c_str())), 2);
  const std::string line = readFile(err);
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
  EXPECT_TRUE(says(line, "p.png: needs Patina's library of pictures"));
  EXPECT_TRUE(says(line, (root / "bin" / "patina_images.so").string()));
}

// This runs in a process of its own: the other tests here have loaded the library.
TEST_F(ImageFileTest, LoadsTheLibraryWithTheFirstPictureOnly) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command = "PATINA_LIBRARY_PROBE=1 '" + self +
                              "' --gtest_also_run_disabled_tests "
                              "--gtest_filter='*DISABLED_Probe' >/dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(ImageFileTest, DISABLED_Probe) {
  if (!std::getenv("PATINA_LIBRARY_PROBE")) GTEST_SKIP();
  saveWorkspace(paintedScene(0.05, 1, With::material), folder);
  loadWorkspace(folder);
  EXPECT_FALSE(loaded("libOpenImageIO"));
  saveWorkspace(paintedScene(0.05, 1, With::all), folder);
  EXPECT_TRUE(loaded("libOpenImageIO"));
}

} // namespace
} // namespace patina
