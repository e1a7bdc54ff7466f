#include "field/store/face_block.h"

#include <gtest/gtest.h>

#include <random>

namespace patina {
namespace {

FaceNodes randomFaces(int different, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int32_t> pick(-1, different - 2);
  FaceNodes nodes;
  for (std::int32_t& face : nodes.face) {
    const std::int32_t picked = pick(random);
    face = picked < 0 ? -1 : 1'000'000 + picked * 7919;
  }
  return nodes;
}

TEST(FaceBlock, ReturnsEveryFaceForAnyNumberOfFaces) {
  for (const int different : {1, 2, 40, 255, 256, 257, 300, 100000}) {
    const FaceNodes nodes = randomFaces(different, static_cast<unsigned>(different));
    const FaceBlock block(nodes);
    for (std::size_t n = 0; n < nodes.face.size(); ++n) {
      ASSERT_EQ(block.at(n), nodes.face[n]) << different << " faces, node " << n;
    }
  }
}

// Blocks of every layout: one face per layer of nodes along an axis, per row, or for all nodes.
TEST(FaceBlock, StoresLayeredFacesCompactlyAlongAnyAxis) {
  for (const int shift : {0, 3, 6}) {
    FaceNodes nodes;
    for (std::size_t n = 0; n < nodes.face.size(); ++n)
      nodes.face[n] = static_cast<std::int32_t>(n >> shift & 7U) - 1;
    const FaceBlock block(nodes);
    for (std::size_t n = 0; n < nodes.face.size(); ++n) ASSERT_EQ(block.at(n), nodes.face[n]);
    EXPECT_LE(block.bytes(), sizeof(FaceBlock) + 8 * 2 + 4); // 8 runs of 3 bits
  }
  for (const std::int32_t face : {12, 1'000'000}) {
    FaceNodes one;
    one.face.fill(face);
    EXPECT_EQ(FaceBlock(one).bytes(), sizeof(FaceBlock) + 2) << face;
  }
  EXPECT_LE(sizeof(FaceBlock), 80U);
}

TEST(FaceBlock, ShiftsFacesButNotTheirAbsence) {
  for (const int different : {2, 40, 300, 100000}) {
    const FaceNodes nodes = randomFaces(different, 7);
    const FaceBlock shifted(FaceBlock(nodes), 12345);
    for (std::size_t n = 0; n < nodes.face.size(); ++n)
      ASSERT_EQ(shifted.at(n), nodes.face[n] < 0 ? -1 : nodes.face[n] + 12345);
  }
}

} // namespace
} // namespace patina
