// The command that lays haptic coordinates along a path.
#include <gtest/gtest.h>

#include "core/file.h"
#include "geometry/io/textured_obj.h"
#include "integration/program.h"

namespace patina::test {
namespace {

class MappedTextures : public testing::Test {
 protected:
  void SetUp() override {
    mesh = folder / "plate.obj";
    path = folder / "path.csv";
    out = folder / "textured.obj";
    // A plate of 80 mm, in millimetres, with two triangles a 10 mm cell.
    std::string text;
    for (int j = 0; j <= 8; ++j)
      for (int i = 0; i <= 8; ++i)
        text += "v " + std::to_string(10 * i - 40) + " " + std::to_string(10 * j - 40) + " 0\n";
    for (int j = 0; j < 8; ++j)
      for (int i = 1; i <= 8; ++i) {
        const int a = 9 * j + i;
        text += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " +
                std::to_string(a + 10) + "\nf " + std::to_string(a) + " " + std::to_string(a + 10) +
                " " + std::to_string(a + 9) + "\n";
      }
    writeFileAtomically(mesh, text);
    writeFileAtomically(path, "x [m],y [m],z [m]\n-0.03,0.003,0\n0.03,0.003,0\n");
  }
  ScratchFolder folder;
  std::string mesh, path, out;
};

TEST_F(MappedTextures, LieAlongThePathInTheUnitOfTheMesh) {
  const Json report = runJson({"map-texture", mesh, path, "-o", out, "--texture", "3"});
  EXPECT_NEAR(report.at("length").asNumber(), 0.06, 1e-12);
  EXPECT_EQ(report.at("strokes").asInteger(), 1);
  const TexturedMesh read = readTexturedObj(out);
  EXPECT_EQ(readMesh(mesh).positions, read.mesh.positions);
  EXPECT_EQ(static_cast<std::int64_t>(read.textured.size()), report.at("faces").asInteger());
  ASSERT_GT(read.textured.size(), 30u);
  for (const TexturedFace& face : read.textured) {
    EXPECT_EQ(face.texture, 3);
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = read.mesh.corner(static_cast<std::size_t>(face.face), k);
      EXPECT_NEAR(face.coords[static_cast<std::size_t>(k)].x(), p.x() + 30, 1e-9);
      EXPECT_NEAR(face.coords[static_cast<std::size_t>(k)].y(), p.y() - 3, 1e-9);
    }
  }
  EXPECT_EQ(run({"info", out}).exit, 0); // any other command reads it as a mesh
}

TEST_F(MappedTextures, UseTheArcLengthOfTheHeights) {
  const std::string timed = folder / "timed.csv", heights = folder / "heights.csv";
  std::string path_rows = "t [s],x [m],y [m],z [m]\n",
              height_rows = "t [s],along [m],height [m],sigma [m],stretch\n";
  for (int i = 0; i <= 60; ++i) { // the path's first half has no heights
    path_rows += std::to_string(0.01 * i) + "," + std::to_string(-0.03 + 1e-3 * i) + ",0.003,0\n";
    if (i >= 30)
      height_rows +=
          std::to_string(0.01 * i) + "," + std::to_string(1.1e-3 * (i - 30)) + ",0,1,4\n";
  }
  writeFileAtomically(timed, path_rows);
  writeFileAtomically(heights, height_rows);
  runJson({"map-texture", mesh, timed, "-o", out, "--heights", heights, "--rings", "0"});
  const TexturedMesh read = readTexturedObj(out);
  ASSERT_GT(read.textured.size(), 4u);
  for (const TexturedFace& face : read.textured)
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = read.mesh.corner(static_cast<std::size_t>(face.face), k);
      EXPECT_NEAR(face.coords[static_cast<std::size_t>(k)].x(), 1.1 * p.x(), 1e-6);
    }
  writeFileAtomically(heights, "t [s],along [m],height [m],sigma [m],stretch\n7,0,0,1,0\n");
  expectOneLineError(run({"map-texture", mesh, timed, "-o", out, "--heights", heights}),
                     {"heights.csv", "no height"});
}

TEST_F(MappedTextures, ReplaceEarlierOnes) {
  runJson({"map-texture", mesh, path, "-o", out, "--texture", "1", "--rings", "100"});
  const std::string both = folder / "both.obj";
  const Json report =
      runJson({"map-texture", out, path, "-o", both, "--texture", "2", "--rings", "0"});
  EXPECT_EQ(report.at("replaced").asInteger(), report.at("faces").asInteger());
  std::size_t second = 0;
  const TexturedMesh read = readTexturedObj(both);
  EXPECT_EQ(read.textured.size(), 128u);
  for (const TexturedFace& face : read.textured) second += face.texture == 2;
  EXPECT_EQ(static_cast<std::int64_t>(second), report.at("faces").asInteger());
}

TEST_F(MappedTextures, AreRefusedWithTheNameOfTheWrongFile) {
  expectOneLineError(run({"map-texture", mesh, folder / "none.csv", "-o", out}), {"none.csv"});
  expectOneLineError(run({"map-texture", mesh, path, "-o", folder / "t.ply"}), {"t.ply", ".obj"});
  writeFileAtomically(folder / "far.csv", "x [m],y [m],z [m]\n-30,3,0\n30,3,0\n");
  expectOneLineError(run({"map-texture", mesh, folder / "far.csv", "-o", out}),
                     {"far.csv", "--unit"});
  writeFileAtomically(folder / "point.csv", "x [m],y [m],z [m]\n0.01,0,0\n");
  expectOneLineError(run({"map-texture", mesh, folder / "point.csv", "-o", out}),
                     {"point.csv", "no length"});
  writeFileAtomically(folder / "bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nh 1 0 0\n");
  expectOneLineError(run({"map-texture", folder / "bad.obj", path, "-o", out}), {"bad.obj:5"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
} // namespace patina::test
