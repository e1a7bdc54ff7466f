#include "field/face_block.h"

#include <gtest/gtest.h>

#include <random>

namespace patina {
namespace {

FaceNodes randomFaces(int different, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int32_t> pick(-1, different - 2);
  FaceNodes nodes;
  for (std::int32_t& face : nodes.face) face = pick(random) * 7919;
  return nodes;
}

TEST(FaceBlock, GivesBackEveryFaceHoweverManyThereAre) {
  for (const int different : {1, 2, 40, 255, 256, 257, 300, 100000}) {
    const FaceNodes nodes = randomFaces(different, static_cast<unsigned>(different));
    const FaceBlock block(nodes);
    for (std::size_t n = 0; n < nodes.face.size(); ++n) {
      ASSERT_EQ(block.at(n), nodes.face[n]) << different << " faces, node " << n;
    }
  }
}

TEST(FaceBlock, ListsUpToTwoHundredAndFiftySixFacesByTheByte) {
  FaceNodes nodes;
  for (std::size_t n = 0; n < nodes.face.size(); ++n) {
    nodes.face[n] = static_cast<std::int32_t>(n % 256);
  }
  const FaceBlock listed(nodes);
  EXPECT_EQ(listed.bytes(), sizeof(FaceBlock) + 256 * 4 + 512);
  nodes.face[300] = 1000;
  const FaceBlock whole(nodes);
  EXPECT_EQ(whole.bytes(), sizeof(FaceBlock) + 512 * 4);
  EXPECT_EQ(whole.at(300), 1000);
}

} // namespace
} // namespace patina
