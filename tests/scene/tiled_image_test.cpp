#include "scene/paint/tiled_image.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

namespace patina {
namespace {

void set(TiledImage& image, int i, int j, int channel, float value) {
  image.writable(image.tileOf(i, j))[image.offsetOf(i, j) + static_cast<std::size_t>(channel)] =
      value;
}

TEST(TiledImage, UnpaintedTexelsAreZeroAndCostNoTile) {
  const TiledImage image(512, 256, 4);
  EXPECT_EQ(image.tileCount(), 16U * 8U);
  for (std::size_t i = 0; i < image.tileCount(); ++i) EXPECT_EQ(image.tile(i), nullptr);
  EXPECT_EQ(image.at(511, 255, 3), 0);
  EXPECT_EQ(image.sample(0.3, 0.7, 2), 0);
  EXPECT_LT(image.bytes(), 4096U);
}

TEST(TiledImage, InvalidSizesAreRejected) {
  EXPECT_THROW(TiledImage(32, 64, 1), std::invalid_argument);
  EXPECT_THROW(TiledImage(64, 100, 1), std::invalid_argument);
  EXPECT_THROW(TiledImage(4128, 64, 1), std::invalid_argument);
  EXPECT_THROW(TiledImage(-64, 64, 1), std::invalid_argument);
  EXPECT_THROW(TiledImage(64, 64, 0), std::invalid_argument);
  EXPECT_THROW(TiledImage(64, 64, 5), std::invalid_argument);
  EXPECT_NO_THROW(TiledImage(64, 4096, 4));
}

// Every texel has its own address.
TEST(TiledImage, TexelsReadBackAtTheirPositions) {
  TiledImage image(96, 64, 3);
  const auto value = [](int i, int j, int c) {
    return static_cast<float>(1 + c + 3 * (i + 96 * j));
  };
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 96; ++i)
      for (int c = 0; c < 3; ++c) set(image, i, j, c, value(i, j, c));
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 96; ++i)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(image.at(i, j, c), value(i, j, c)) << i << " " << j;
}

// This holds even if the copy is gone: its last reader may be on another thread.
TEST(TiledImage, PublishedTilesAreImmutable) {
  TiledImage image(64, 64, 1);
  set(image, 5, 5, 0, 1);
  const float* const own = image.tile(0);
  set(image, 6, 5, 0, 2);
  EXPECT_EQ(image.tile(0), own); // not published yet
  auto seen = std::make_unique<const TiledImage>(image.published());
  std::weak_ptr<TiledImage::Tile> tile = seen->sharedTile(0);
  const auto kept = tile.lock();
  seen.reset();
  set(image, 7, 5, 0, 3);
  EXPECT_NE(image.tile(0), kept->data());
  EXPECT_EQ((*kept)[image.offsetOf(7, 5)], 0);
}

TEST(TiledImage, PublishedTileIsCopiedEvenIfReleased) {
  TiledImage image(64, 64, 1);
  set(image, 5, 5, 0, 1);
  std::weak_ptr<TiledImage::Tile> tile = image.sharedTile(0);
  { const TiledImage seen = image.published(); }
  set(image, 6, 5, 0, 2);
  EXPECT_TRUE(tile.expired()); // replaced, not written
}

// Threads write like LayImage does; for the thread sanitizer.
TEST(TiledImage, ThreadsWriteDifferentTilesAtOnce) {
  TiledImage before(256, 256, 1);
  set(before, 0, 0, 0, 7);
  TiledImage image = before;
  std::vector<std::thread> threads;
  for (std::size_t part = 0; part < 4; ++part)
    threads.emplace_back([&, part] {
      for (std::size_t t = part; t < image.tileCount(); t += 4)
        image.writable(t)[1] = static_cast<float>(t);
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < image.tileCount(); ++t)
    ASSERT_EQ(image.tile(t)[1], static_cast<float>(t));
  EXPECT_EQ(image.at(0, 0, 0), 7);
  EXPECT_EQ(before.at(1, 0, 0), 0);
}

TEST(TiledImage, CopiesShareTilesUntilOneIsWritten) {
  TiledImage image(64, 64, 1);
  set(image, 5, 5, 0, 1.5f);
  set(image, 40, 40, 0, 2.5f);
  TiledImage copy = image;
  EXPECT_EQ(copy.sharedTile(0), image.sharedTile(0));
  set(copy, 5, 5, 0, 9);
  EXPECT_EQ(image.at(5, 5, 0), 1.5f);
  EXPECT_EQ(copy.at(5, 5, 0), 9);
  EXPECT_NE(copy.sharedTile(0), image.sharedTile(0));
  EXPECT_EQ(copy.sharedTile(3), image.sharedTile(3)); // the other tile is shared
  const float* own = copy.writable(0);
  EXPECT_EQ(copy.writable(0), own); // a tile of one owner is written in place
}

TEST(TiledImage, SamplesAreBilinearBetweenCentresAndClampedAtTheBorder) {
  TiledImage image(128, 64, 1);
  // The image is affine in the texel centres, so bilinear interpolation is exact.
  const auto plane = [](double u, double v) { return 3 - 2 * u + 5 * v; };
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 128; ++i)
      set(image, i, j, 0, static_cast<float>(plane((i + 0.5) / 128, (j + 0.5) / 64)));
  std::mt19937 random(4);
  std::uniform_real_distribution<double> inside(0.01, 0.99);
  for (int n = 0; n < 200; ++n) {
    const double u = inside(random), v = inside(random);
    EXPECT_NEAR(image.sample(u, v, 0), plane(u, v), 1e-6);
  }
  EXPECT_EQ(image.sample(0, 0, 0), static_cast<double>(image.at(0, 0, 0)));
  EXPECT_EQ(image.sample(1, 1, 0), static_cast<double>(image.at(127, 63, 0)));
}

TEST(TiledImage, SameIsBitwiseAndTreatsAbsentAsZero) {
  TiledImage a(64, 64, 1), b(64, 64, 1);
  b.writable(2);
  EXPECT_TRUE(same(a, b));
  EXPECT_TRUE(same(b, a));
  set(b, 0, 40, 0, 1);
  EXPECT_FALSE(same(a, b));
  set(a, 0, 40, 0, 1);
  EXPECT_TRUE(same(a, b));
  set(a, 0, 0, 0, std::numeric_limits<float>::quiet_NaN());
  b = a;
  EXPECT_TRUE(same(a, b)); // bits, not values
  EXPECT_FALSE(same(TiledImage(64, 64, 1), TiledImage(64, 96, 1)));
  EXPECT_FALSE(same(TiledImage(64, 64, 1), TiledImage(64, 64, 4)));
}

TEST(TiledImage, EmptyTilesCanBeDropped) {
  TiledImage image(64, 64, 1);
  set(image, 0, 0, 0, 1);
  set(image, 40, 0, 0, 1);
  set(image, 0, 0, 0, 0);
  image.dropEmptyTiles();
  EXPECT_EQ(image.tile(0), nullptr);
  EXPECT_NE(image.tile(1), nullptr);
}

} // namespace
} // namespace patina
