// Colours and pictures of a mesh file on each vertex and triangle.
#include <chrono>

#include <gtest/gtest.h>

#include "core/file.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/textured_obj.h"
#include "support/fresh_folder.h"

namespace patina {
namespace {

using Warnings = std::vector<std::string>;

constexpr Rgba kNone{};
constexpr Rgba kRed{1, 0, 0, 1};
constexpr Rgba kWhite{1, 1, 1, 1};

void expectNear(const std::vector<Rgba>& colors, const std::vector<Rgba>& wanted) {
  ASSERT_EQ(colors.size(), wanted.size());
  for (std::size_t i = 0; i < colors.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(colors[i][c], wanted[i][c], 1e-6) << i;
}

TEST(ObjColors, VertexColorsAreFractionsOrBytesWithOrWithoutOpacity) {
  for (const char* text : {"v 0 0 0 1 0 0\nv 1 0 0 0 .2 1\nv 0 1 0 1 1 1\nf 1 2 3\n",
                           "v 0 0 0 255 0 0\nv 1 0 0 0 51 255\nv 0 1 0 255 255 255\nf 1 2 3\n",
                           "v 0 0 0 1 0 0 1\nv 1 0 0 0 .2 1 1\nv 0 1 0 1 1.001 1.9 1\nf 1 2 3\n"}) {
    MeshColors colors;
    Warnings warnings;
    parseObj(text, "t", &warnings, &colors);
    expectNear(colors.vertices, {kRed, {0, 0.2F, 1, 1}, kWhite});
    EXPECT_TRUE(warnings.empty());
    EXPECT_TRUE(colors.faces.empty() && colors.picture_of.empty());
  }
}

TEST(ObjColors, PartialVertexColorsAreReported) {
  MeshColors colors;
  Warnings warnings;
  parseObj("v 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0\nf 1 2 3\n", "t", &warnings, &colors);
  expectNear(colors.vertices, {kNone, kRed, kNone});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "2 of 3 vertices have no colour");
}

TEST(ObjColors, AreAbsentIfNotFinite) {
  MeshColors colors;
  parseObj("v 0 0 0 nan 0 0\nv 1 0 0 1 0 0\nv 0 1 0 inf 0 0\nf 1 2 3\n", "t", nullptr, &colors);
  expectNear(colors.vertices, {kNone, kRed, kNone});
}

TEST(ObjColors, AreAbsentForAPlainMesh) {
  MeshColors colors;
  parseObj("v 0 0 0 1\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", "t", nullptr, &colors);
  EXPECT_TRUE(colors.empty());
}

class MaterialColors : public testing::Test {
 protected:
  void SetUp() override { folder_ = test::freshFolder("material colors"); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  // Two quads and a triangle, each with its own material.
  MeshColors read(const std::string& library, bool mapped = true) {
    writeFileAtomically(folder_ / "a.mtl", library);
    const std::string text =
        mapped ? "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl one\nf 1/1 2/2 3/3 4/4\nusemtl two\n"
                 "f 4/4 3/3 2/2 1/1\nusemtl three\nf 1/1 2/2 3/3\n"
               : "usemtl one\nf 1 2 3 4\nusemtl two\nf 4 3 2 1\nusemtl three\nf 1 2 3\n";
    writeFileAtomically(folder_ / "a.obj",
                        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" + text);
    MeshColors colors;
    warnings_ = readTexturedObj(folder_ / "a.obj", &colors).warnings;
    return colors;
  }
  std::filesystem::path folder_;
  Warnings warnings_;
};

TEST_F(MaterialColors, ApplyToTheFacesThatUseThem) {
  const MeshColors colors =
      read("newmtl two\nKd 1 0 0\nnewmtl one\nKd 0 .5 2\nnewmtl three\nKd 1 1 1\n", false);
  const Rgba blue{0, 0.5F, 1, 1};
  expectNear(colors.faces, {blue, blue, kRed, kRed, kWhite});
  EXPECT_TRUE(colors.picture_of.empty());
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(MaterialColors, AreAbsentForASingleGrey) {
  EXPECT_TRUE(read("newmtl one\nKd .8 .8 .8\nnewmtl two\nKd .8 .8 .8\nnewmtl three\n").empty());
}

TEST_F(MaterialColors, HaveOnePicturePerMaterialWithItsFolder) {
  std::filesystem::create_directories(folder_ / "tex");
  writeFileAtomically(folder_ / "tex" / "a b.png", "");
  const MeshColors colors = read("newmtl one\nmap_Kd -s 2 3 1 -o .5 -clamp on tex\\a b.png\n"
                                 "newmtl two\nKd 1 0 0\nnewmtl three\nmap_Kd gone.png\n");
  EXPECT_EQ(colors.picture_of, (std::vector<std::int32_t>{0, 0, -1, -1, 1}));
  ASSERT_EQ(colors.pictures.size(), 2u);
  EXPECT_EQ(colors.pictures[0].file, folder_ / "tex" / "a b.png");
  EXPECT_EQ(colors.pictures[0].scale, Vec2(2, 3));
  EXPECT_EQ(colors.pictures[0].offset, Vec2(0.5, 0));
  EXPECT_FALSE(colors.pictures[0].repeats);
  EXPECT_EQ(colors.pictures[1].file, folder_ / "gone.png");
  EXPECT_TRUE(colors.pictures[1].repeats);
  expectNear(colors.faces, {kWhite, kWhite, kRed, kRed, kWhite});
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(MaterialColors, AreNamedIfMissingFromAllLibraries) {
  const MeshColors colors = read("newmtl one\nKd 1 0 0\n");
  expectNear(colors.faces, {kRed, kRed, kNone, kNone, kNone});
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_EQ(warnings_[0], "no library of the mesh has the material 'three' and 1 more: its faces "
                          "have no colour");
}

TEST_F(MaterialColors, NonFiniteNumbersAreSkipped) {
  const MeshColors colors = read("newmtl one\nKd nan 0 1\nnewmtl two\r\nKd 1 0 0\r\nnewmtl three\n"
                                 "map_Kd -s inf 2 -o nan 1e308 a.png\nKd .5\n");
  expectNear(colors.faces, {kNone, kNone, kRed, kRed, {0.5F, 0.5F, 0.5F, 1}});
  EXPECT_EQ(colors.pictures.at(0).scale, Vec2(1, 2));
}

TEST_F(MaterialColors, PicturesBesideTheLibraryComeFirst) {
  for (const char* place : {"lib/t.png", "t.png"}) {
    std::filesystem::create_directories((folder_ / place).parent_path());
    writeFileAtomically(folder_ / place, "");
  }
  writeFileAtomically(folder_ / "lib/a.mtl", "newmtl one #2\nmap_Kd t.png\nd 0.5\n");
  writeFileAtomically(folder_ / "a.obj",
                      "mtllib lib/a.mtl # mine\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                      "usemtl one #2\nf 1/1 2/1 3/1\n");
  MeshColors colors;
  const Warnings warnings = readTexturedObj(folder_ / "a.obj", &colors).warnings;
  EXPECT_EQ(colors.pictures.at(0).file, folder_ / "lib" / "t.png");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("transparency is left out"), std::string::npos);
}

TEST_F(MaterialColors, AreKeptIfThePictureCannotBeMapped) {
  expectNear(read("newmtl one\nKd 1 0 0\nmap_Kd a.png\n", false).faces,
             {kRed, kRed, kNone, kNone, kNone});
}

TEST_F(MaterialColors, AreReadQuicklyForManyMaterials) {
  std::string library, text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 40000; ++i) {
    library +=
        "newmtl m" + std::to_string(i) + "\nKd 1 0 0\nmap_Kd p" + std::to_string(i) + ".png\n";
    text += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
  }
  writeFileAtomically(folder_ / "a.mtl", library);
  writeFileAtomically(folder_ / "a.obj", text);
  MeshColors colors;
  const auto began = std::chrono::steady_clock::now();
  readTexturedObj(folder_ / "a.obj", &colors);
  EXPECT_EQ(colors.faces.size(), 40000u);
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5)); // 0.1; 14 before
}

std::string ply(const std::string& type, const std::string& names, const std::string& values) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
                     "y\nproperty float z\n";
  for (std::size_t at = 0; at < names.size(); at += 2)
    text += "property " + type + " " +
            (names[at] == 'R'   ? "red"
             : names[at] == 'G' ? "green"
             : names[at] == 'B' ? "blue"
             : names[at] == 'r' ? "r"
             : names[at] == 'g' ? "g"
                                : "b") +
            "\n";
  return text + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 " +
         values + "\n1 0 0 " + values + "\n0 1 0 " + values + "\n3 0 1 2\n";
}

TEST(PlyColors, VertexColorsAreReadFromEveryType) {
  const Rgba wanted{1, 0.2F, 0, 1};
  for (const auto& [type, names, values] : {std::tuple{"uchar", "R G B ", "255 51 0"},
                                            {"ushort", "R G B ", "65535 13107 0"},
                                            {"float", "R G B ", "1 .2 0"},
                                            {"double", "R G B ", "255 51 0"},
                                            {"int", "B G R ", "0 51 255"},
                                            {"uchar", "r g b ", "255 51 0"}}) {
    MeshColors colors;
    parsePly(ply(type, names, values), "t", nullptr, &colors);
    expectNear(colors.vertices, {wanted, wanted, wanted});
  }
}

TEST(PlyColors, FaceColorsApplyToEachTriangleOfAPolygon) {
  MeshColors colors;
  Warnings warnings;
  const TriangleMesh mesh = parsePly(
      "ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile b.png\n"
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 3\n"
      "property uchar red\nproperty list uchar int vertex_indices\nproperty uchar green\nproperty "
      "uchar blue\nproperty list uchar float texcoord\nproperty int texnumber\nend_header\n0 0 0\n"
      "1 0 0\n1 1 0\n0 1 0\n255 4 0 1 2 3 0 0 8 0 0 1 0 1 1 0 1 1\n0 3 0 1 2 51 255 6 0 0 1 0 1 1 "
      "0\n255 3 2 1 0 255 255 6 0 0 1 0 1 1 7\n",
      "/x/t.ply", &warnings, &colors);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  expectNear(colors.faces, {kRed, kRed, {0, 0.2F, 1, 1}, kWhite});
  EXPECT_EQ(colors.picture_of, (std::vector<std::int32_t>{1, 1, 0, -1}));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "1 triangles name a picture (texnumber) that the header does not");
  ASSERT_EQ(colors.pictures.size(), 2u);
  EXPECT_EQ(colors.pictures[1].file, "/x/b.png");
}

TEST(PlyColors, AreAbsentForStrips) {
  const std::string faces =
      "element face 1\nproperty list uchar int vertex_indices\nproperty uchar "
      "red\nproperty uchar green\nproperty uchar blue\n";
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty "
                           "float y\nproperty float z\n";
  const std::string corners = "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  MeshColors first, last;
  parsePly(head + strips + faces + corners + "4 0 1 2 3\n3 0 1 2 255 0 0\n", "t", nullptr, &last);
  parsePly(head + faces + strips + corners + "3 0 1 2 255 0 0\n4 0 1 2 3\n", "t", nullptr, &first);
  expectNear(first.faces, {kRed, kNone, kNone});
  expectNear(last.faces, {kNone, kNone, kRed});
}

TEST(PlyColors, AreReportedIfDropped) {
  Warnings warnings;
  MeshColors colors;
  std::string text = ply("uchar", "R G B ", "255 51 0");
  parsePly(text.replace(text.find("blue"), 4, "teal"), "t", &warnings, &colors);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "colours are left out that are not red, green and blue");
  EXPECT_TRUE(colors.empty());
  warnings.clear();
  parsePly("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
           "float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar "
           "alpha\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 9 9 9 "
           "255\n1 0 0 9 9 9 9\n0 1 0 9 9 9 255\n3 0 1 2\n",
           "t", &warnings, &colors);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("transparency is left out"), std::string::npos);
}

} // namespace
} // namespace patina
