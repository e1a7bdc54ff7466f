#include "workspace/paint_files.h"

#include "workspace/workspace_support.h"

namespace patina {
namespace {

std::string errorOfParsing(const std::string& bytes) {
  return errorOf([&] { parseMaterial(bytes, "m"); });
}

TEST(MaterialFile, ReadsBackBitForBit) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const MaterialMap map = paintedMaterial(seed);
    const std::string bytes = materialBytes(map);
    const MaterialMap read = parseMaterial(bytes, "m");
    EXPECT_TRUE(same(map, read));
    EXPECT_EQ(materialBytes(read), bytes);
  }
  const MaterialMap empty(Vec3::Zero(), 1);
  EXPECT_TRUE(same(empty, parseMaterial(materialBytes(empty), "m")));
}

TEST(MaterialFile, IsSparse) {
  // Eight layers of 512 values and weights.
  EXPECT_LT(materialBytes(paintedMaterial(1)).size(), 8 * 4096 + 1000);
}

TEST(MaterialFile, EveryTruncationAndEveryLongerFileIsAnError) {
  const std::string bytes = materialBytes(paintedMaterial(1));
  for (std::size_t size = 0; size < bytes.size(); size += size < 600 ? 1 : 97)
    ASSERT_NE(errorOfParsing(bytes.substr(0, size)), "") << size;
  EXPECT_TRUE(says(errorOfParsing(bytes + '\0'), "more data than the header says"));
}

TEST(MaterialFile, BadHeadersAreNamed) {
  const std::string bytes = materialBytes(paintedMaterial(1));
  for (const auto& [from, to, part] : std::vector<std::array<std::string, 3>>{
           {"patina material", "another thing", "is not a painted material"},
           {"\"version\":1", "\"version\":7", "version 7 is unknown"},
           {"\"blocks\":4", "\"blocks\":4000000000000", "more than the file holds"},
           {"\"blocks\":4", "\"blocks\":-4", "more than the file holds"},
           {"\"blocks\":4", "\"blocks\":3", "more data than the header says"},
           {"\"voxel\":0.002", "\"voxel\":0", "do not define a grid"},
           {"\"name\":\"damping\"", "\"name\":\"colour\"", "channel 'colour' is unknown"}}) {
    std::string changed = bytes;
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    changed.replace(at, from.size(), to);
    EXPECT_TRUE(says(errorOfParsing(changed), part)) << errorOfParsing(changed);
  }
}

TEST(MaterialFile, BadBlocksAreRefused) {
  const std::string bytes = materialBytes(paintedMaterial(1));
  const std::size_t body = bytes.find('\n') + 1;
  const auto with = [&](std::size_t at, std::uint32_t value) {
    std::string changed = bytes;
    std::memcpy(changed.data() + body + at, &value, sizeof value);
    return errorOfParsing(changed);
  };
  EXPECT_TRUE(says(with(0, 0x7fffffff), "outside the supported range"));
  EXPECT_TRUE(says(with(0, 5), "out of order")); // the second block's index is below it
  EXPECT_TRUE(says(with(12, 0xffffffff), "a channel that the header does not name"));
  EXPECT_TRUE(says(with(16, 0x7fc00000), "not a finite number")); // NaN
  EXPECT_TRUE(says(with(16, 0x7f800000), "not a finite number")); // infinity
}

// Two blocks in opposite corners of the world: a dense table between them would fill any memory.
TEST(MaterialFile, BlocksTooFarApartAreRefused) {
  MaterialMap map(Vec3::Zero(), 0.002);
  map.writable({0, 0, 0}, MaterialChannel::damping);
  map.writable({255, 255, 255}, MaterialChannel::damping);
  const std::string bytes = materialBytes(map);
  EXPECT_TRUE(same(parseMaterial(bytes, "m"), map)); // 2^24, the maximum
  const std::size_t last = bytes.size() - sizeof(MaterialLayer) - 16;
  for (const std::int32_t far : {256, (1 << 28) - 1}) {
    std::string changed = bytes;
    std::memcpy(changed.data() + last, &far, sizeof far);
    EXPECT_TRUE(says(errorOfParsing(changed), "too large a box"));
  }
  map.writable({0, 0, 256}, MaterialChannel::damping);
  EXPECT_THROW(materialBytes(map), Error);
}

TEST(MaterialFile, RefusesToWriteUnreadableValues) {
  MaterialMap map = paintedMaterial(1);
  map.writable({0, 0, 0}, MaterialChannel::damping).value[7] = std::nanf("");
  EXPECT_THROW(materialBytes(map), Error);
}

} // namespace
} // namespace patina
