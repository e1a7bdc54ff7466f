// Haptic coordinates in an OBJ (A26).
#include "geometry/io/textured_obj.h"

#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

// The plane of Andrews and Lang's figure 10.
const std::string kPlane = "v -40 0 40\nv -40 0 -40\nv 40 0 40\nv 40 0 -40\n"
                           "f 1 3 2\nf 2 3 4\n"
                           "h 1 0 0 0 50 50 0\nh 1 50 0 0 50 50 50\n";

std::string failureOf(const std::string& text) {
  try {
    parseTexturedObj(text, "a.obj");
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(TexturedObj, ReadsThePublishedPlane) {
  const TexturedMesh read = parseTexturedObj(kPlane, "plane.obj");
  ASSERT_EQ(read.mesh.triangles.size(), 2u);
  ASSERT_EQ(read.textured.size(), 2u);
  EXPECT_EQ(read.textured[1].face, 1);
  EXPECT_EQ(read.textured[1].texture, 1);
  EXPECT_EQ(read.textured[1].coords[0], Vec2(50, 0));
  EXPECT_EQ(read.textured[1].coords[1], Vec2(0, 50));
  EXPECT_EQ(read.textured[1].coords[2], Vec2(50, 50));
}

TEST(TexturedObj, IsSkippedByOtherReaders) {
  EXPECT_EQ(parseObj(kPlane, "plane.obj").triangles.size(), 2u);
  EXPECT_EQ(parseObj(kPlane + "h what this is\n", "plane.obj").triangles.size(), 2u);
}

TEST(TexturedObj, HasNoTextureWithoutCoordinates) {
  EXPECT_TRUE(parseTexturedObj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4 3\n", "a.obj")
                  .textured.empty());
}

TEST(TexturedObj, ReadsTheFormsOfOtherPrograms) {
  const TexturedMesh read = parseTexturedObj(
      "## made by hand\r\nv 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nvt 0 0\r\nvn 0 0 1\r\n"
      "f -3/1/1 -2/1/1 -1/1/1\r\nh 7 0 0 1 0 \\\r\n 0 1 # left\r\nf 1 3 2\r\nh -1\r\n",
      "a.obj");
  ASSERT_EQ(read.textured.size(), 1u);
  EXPECT_EQ(read.textured[0].texture, 7);
  EXPECT_EQ(read.textured[0].coords[2], Vec2(0, 1));
}

TEST(TexturedObj, ReadsBackBitForBit) {
  const std::filesystem::path folder = testing::TempDir();
  const auto a = folder / "textured_a.obj", b = folder / "textured_b.obj";
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-0.1, 0.1);
  const TriangleMesh mesh = icosphere(0.03, 4);
  std::vector<TexturedFace> textured;
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(mesh.triangles.size()); f += 3)
    textured.push_back(
        {f,
         f % 5,
         {Vec2(any(random), any(random)), Vec2(any(random), -0.0), Vec2(1e-300, any(random) / 3)}});
  writeTexturedObj(a, mesh, textured);
  const TexturedMesh read = readTexturedObj(a);
  EXPECT_EQ(read.textured, textured);
  EXPECT_EQ(read.mesh.triangles, mesh.triangles);
  EXPECT_EQ(read.mesh.positions, mesh.positions);
  writeTexturedObj(b, read.mesh, read.textured);
  EXPECT_EQ(readFile(a), readFile(b));
  EXPECT_EQ(readMesh(a).triangles, mesh.triangles);
}

TEST(TexturedObj, NamesTheLineOfAFault) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  EXPECT_NE(failureOf(three + "f 1 2 3\nf 2 4 3\nh 1 0 0 0 0 0 0\n").find("1 of 2 faces"),
            std::string::npos);
  EXPECT_NE(failureOf(three + "f 1 2 3\nh 1 0 0 0 0 0\n").find("a.obj:6"), std::string::npos);
  EXPECT_NE(failureOf(three + "f 1 2 3\nh 1 0 0 0 0 0 0 0\n").find("three pairs"),
            std::string::npos);
  EXPECT_NE(failureOf(three + "f 1 2 3\nh 1 0 0 nan 0 0 0\n").find("a.obj:6"), std::string::npos);
  EXPECT_NE(failureOf(three + "f 1 2 3\nh -2 0 0 0 0 0 0\n").find("'-2'"), std::string::npos);
  EXPECT_NE(failureOf(three + "f 1 2 3\nh 99999999999 0 0 0 0 0 0\n").find("texture's number"),
            std::string::npos);
  EXPECT_NE(failureOf(three + "f 1 2 4 3\nh 1 0 0 0 0 0 0\nh 1 0 0 0 0 0 0\n").find("a.obj:5"),
            std::string::npos);
  EXPECT_THROW(readTexturedObj("a.ply"), FileError);
}

} // namespace
} // namespace patina
