// Files of other programs are read, with one line for each kind of dropped data.
#include <cstring>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/obj_materials.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/shapes.h"
#include "support/fresh_folder.h"

namespace patina {
namespace {

using Warnings = std::vector<std::string>;

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

std::string withCarriageReturns(std::string text) {
  std::replace(text.begin(), text.end(), '\n', '\r');
  return text;
}

void expectOne(const Warnings& warnings, const std::string& part) {
  ASSERT_EQ(warnings.size(), 1u) << (warnings.empty() ? "" : warnings[1]);
  EXPECT_NE(warnings[0].find(part), std::string::npos) << warnings[0];
  EXPECT_EQ(warnings[0].find('\n'), std::string::npos);
}

Warnings warningsOfObj(const std::string& text, std::size_t triangles = 1) {
  Warnings warnings;
  EXPECT_EQ(parseObj(text, "t", &warnings).triangles.size(), triangles);
  return warnings;
}

TEST(RealObj, MissingNormalsAreCounted) {
  expectOne(warningsOfObj(kCorners + "f 1//1 2//1 3//1\n"), "line 5: 3 of the faces' corners name");
  expectOne(warningsOfObj(kCorners + "vn 0 0 1\nf 1//1 2//2 3//0\n"), "2 of the faces' corners");
  expectOne(warningsOfObj(kCorners + "f 1//-1 2//-2 3//99999999999999999999\n"), "3 of");
  EXPECT_TRUE(warningsOfObj(kCorners + "f 1//1 2//1 3//1\nvn 0 0 1\n").empty()); // they may follow
}

TEST(RealObj, MissingTexturePointsDropTheTexture) {
  Warnings warnings;
  const TriangleMesh mesh = parseObj(
      kCorners + "vt 0 0\nvt 1 0\nf 1/1 2/2 3/3\nf 1/1 2/2 4/0\nf 1/1 2/-1 4/-3\n", "t", &warnings);
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_TRUE(mesh.corner_uvs.empty());
  expectOne(warnings, "line 7: 3 of the faces' corners name a texture point that is not there");
}

TEST(RealObj, PartialTextureIsReportedAsDropped) {
  expectOne(warningsOfObj(kCorners + "vt 0 0\nf 1/1 2/1 3/1\nf 1 2 4\n", 2),
            "1 of 2 triangles have none");
}

TEST(RealObj, VertexColorsAreReportedAsDropped) {
  expectOne(warningsOfObj("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n"),
            "the colours of its vertices are left out");
  EXPECT_TRUE(warningsOfObj("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n").empty()); // weights
}

TEST(RealObj, PointCloudIsNamedAsSuch) {
  try {
    parseObj(kCorners, "t");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("a point cloud of 4 points, not a mesh"),
              std::string::npos);
  }
}

TEST(RealObj, LinesMayEndInCarriageReturns) {
  const TriangleMesh mesh =
      parseObj(withCarriageReturns("# old\n" + kCorners + "f 1 2 3\nf 1 \\\n2 4\n"), "t");
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

class Materials : public testing::Test {
 protected:
  void SetUp() override { folder_ = test::freshFolder("materials"); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    writeFileAtomically(folder_ / name, text);
  }
  Warnings read(const std::string& file, const std::string& text) {
    write(file, text);
    Warnings warnings;
    readMesh(folder_ / file, &warnings);
    return warnings;
  }
  const std::string face_ = kCorners + "vt 0 0\nvt 1 0\nvt 0 1\nusemtl skin\nf 1/1 2/2 3/3\n";
  std::filesystem::path folder_;
};

TEST_F(Materials, UsedPicturesAreNamedIfOnlyTheSurfaceIsRead) {
  write("a.mtl", "newmtl other\nmap_Kd unused.png\nnewmtl skin\nKd 1 1 1\nmap_Kd a b.png\n");
  write("a b.png", "");
  expectOne(read("cup.obj", "mtllib a.mtl\n" + face_),
            "a picture is left out, 'a b.png': only the surface is read here");
}

TEST_F(Materials, FoldersOptionsAndNamesOfOtherSystemsAreRead) {
  const auto pictureOf = [&](const std::string& file, const std::string& text) {
    write(file, text);
    MeshColors colors;
    readMesh(folder_ / file, nullptr, &colors);
    return colors.pictures.empty() ? std::filesystem::path() : colors.pictures[0].file;
  };
  write("my parts/a.mtl",
        "NEWMTL skin\r\n\tmap_kd -s 2 2 1 -clamp on -o 0.5 C:\\work\\tex\\t.png\r\n");
  write("t.png", "");
  EXPECT_EQ(pictureOf("a.obj", "mtllib my parts\\a.mtl\r\n" + face_), folder_ / "t.png");
  write("b.mtl", withCarriageReturns("newmtl skin\nKd .2 .4 .6\nmap_Kd tex/u.png\n"));
  write("tex/u.png", "");
  EXPECT_EQ(pictureOf("b.obj", "mtllib a.none b.mtl\n" + face_), folder_ / "tex/u.png");
}

TEST_F(Materials, ColorsAndMissingFilesAreReported) {
  expectOne(read("a.obj", "mtllib none.mtl\n" + face_), "'none.mtl' cannot be read");
  write("grey.mtl", "newmtl skin\nKd 0.8 0.8 0.8\n");
  EXPECT_TRUE(read("b.obj", "mtllib grey.mtl\n" + face_).empty());
  write("red.mtl", "newmtl skin\nKd 1 0 0\n");
  expectOne(read("c.obj", "mtllib red.mtl\n" + face_), "the colours of its materials");
  write("two.mtl", "newmtl skin\nmap_Kd x.png\nnewmtl hair\nmap_Kd y.png\n");
  expectOne(read("d.obj", "mtllib two.mtl\n" + face_ + "usemtl hair\nf 1/1 2/2 4/3\n"),
            "pictures are left out, 'x.png' and 1 more");
  write("odd.mtl", "Kd 1 0 0\nnewmtl skin\nKd red\nmap_Kd\nmap_Kd -s\nKd 1 2\n");
  EXPECT_LE(read("e.obj", "mtllib odd.mtl\n" + face_).size(), 1u);
  expectOne(read("f.obj", "mtllib .\n" + face_), "cannot be read");
}

std::string plyOf(const std::string& vertex, const std::string& middle, const std::string& body) {
  return "ply\nformat ascii 1.0\ncomment made\n" + vertex +
         "property float x\nproperty float y\nproperty float z\n" + middle + "end_header\n" + body;
}
const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kStrips = "element tristrips 1\nproperty list int int vertex_indices\n";
const std::string kFive = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";

TEST(RealPly, StripsAreTrianglesOfAlternatingDirection) {
  const TriangleMesh mesh =
      parsePly(plyOf("element vertex 5\n", kStrips, kFive + "10 0 1 2 3 4 -1 0 3 1 -1\n"), "t");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {0, 3, 1}}));
  double upwards = 0;
  for (std::size_t t = 0; t < 3; ++t) upwards += faceNormal(mesh, t).z();
  EXPECT_EQ(upwards, 3);
}

TEST(RealPly, StripsAreJoinedByRepeatedVerticesAndOccurBesideFaces) {
  EXPECT_EQ(
      parsePly(plyOf("element vertex 5\n", kStrips, kFive + "8 0 1 2 2 3 3 1 4\n"), "t").triangles,
      (std::vector<Triangle>{{0, 1, 2}, {1, 3, 4}}));
  EXPECT_EQ(
      parsePly(plyOf("element vertex 5\n", kFaces + kStrips, kFive + "3 0 1 2\n4 -1 2 3 4\n"), "t")
          .triangles.size(),
      2u);
  for (const char* strip :
       {"2 0 1\n", "4 -1 -1 -1 -1\n", "5 0 1 -1 2 3\n", "3 0 1 5\n", "3 0 1 -2\n"})
    EXPECT_THROW(parsePly(plyOf("element vertex 5\n", kStrips, kFive + strip), "t"), FileError);
}

TEST(RealPly, PointCloudIsNamedAsSuch) {
  for (const std::string& middle :
       {std::string(), std::string("element face 0\nproperty list uchar int vertex_indices\n")})
    try {
      parsePly(plyOf("element vertex 5\n", middle, kFive), "t");
      FAIL();
    } catch (const FileError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("a point cloud of 5 points, not a mesh"), std::string::npos) << what;
      EXPECT_NE(what.find("surface reconstruction"), std::string::npos) << what;
    }
}

TEST(RealPly, ColorsAndPicturesAreReportedAsDropped) {
  Warnings warnings;
  parsePly("ply\nformat ascii 1.0\ncomment TextureFile my skin.png\nelement vertex 3\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float x\n"
           "property float y\nproperty float z\nelement face 1\nproperty list uchar int "
           "vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
           "end_header\n9 9 9 0 0 0\n9 9 9 1 0 0\n9 9 9 0 1 0\n3 0 1 2 9 9 9\n",
           "t", &warnings);
  ASSERT_EQ(warnings.size(), 3u);
  EXPECT_NE(warnings[0].find("colours of its vertices"), std::string::npos);
  EXPECT_NE(warnings[1].find("colours of its faces"), std::string::npos);
  EXPECT_EQ(warnings[2],
            "a picture is left out, 'my skin.png': the mesh has no texture coordinates "
            "that are kept");
}

TEST(RealPly, LinesMayEndInCarriageReturns) {
  const std::string text = plyOf("element vertex 5\n", kFaces, kFive + "3 0 1 2\n");
  EXPECT_EQ(parsePly(withCarriageReturns(text), "t").positions.size(), 5u);
  std::string binary = "ply\rformat binary_little_endian 1.0\relement vertex 3\rproperty float x\r"
                       "property float y\rproperty float z\relement face 1\r"
                       "property list uchar int vertex_indices\rend_header\r";
  const float numbers[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::int32_t face[3] = {0, 1, 2};
  binary.append(reinterpret_cast<const char*>(numbers), sizeof numbers).append("\3");
  binary.append(reinterpret_cast<const char*>(face), sizeof face);
  EXPECT_EQ(parsePly(binary, "t").triangles.size(), 1u);
}

TEST(RealPly, NonConvexPolygonKeepsItsOutlineAndTexture) {
  const TriangleMesh mesh =
      parsePly(plyOf("element vertex 4\n",
                     "element face 1\nproperty list uchar int vertex_indices\n"
                     "property list uchar float texcoord\n",
                     "0 0 0\n3 0 0\n3 3 0\n2 1 0\n4 0 1 2 3 8 0 0 3 0 3 3 2 1\n"),
               "t");
  EXPECT_DOUBLE_EQ(area(mesh), 3.0);
  ASSERT_EQ(mesh.corner_uvs.size(), 2u);
  for (std::size_t t = 0; t < 2; ++t)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(mesh.corner_uvs[t][static_cast<std::size_t>(k)], mesh.corner(t, k).head<2>());
}

std::string binaryStl(const TriangleMesh& mesh, std::uint32_t count, std::string header = "made") {
  header.resize(80, ' ');
  header.append(reinterpret_cast<const char*>(&count), sizeof count);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    header.append(12, '\0');
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) {
        const auto value = static_cast<float>(mesh.corner(t, c)[k]);
        header.append(reinterpret_cast<const char*>(&value), sizeof value);
      }
    header.append(2, '\0');
  }
  return header;
}

Warnings warningsOfStl(const std::string& bytes, std::size_t triangles) {
  Warnings warnings;
  EXPECT_EQ(parseStl(bytes, "t", &warnings).triangles.size(), triangles);
  return warnings;
}

TEST(RealStl, BytesAfterTheLastTriangleAreIgnored) {
  const TriangleMesh cube = box(Vec3(1, 1, 1));
  for (const char* header : {"made", "solid in name only"}) {
    const std::string whole = binaryStl(cube, 12, header);
    EXPECT_TRUE(warningsOfStl(whole, 12).empty());
    expectOne(warningsOfStl(whole + "\n", 12), "1 byte after the last triangle: left out");
    expectOne(warningsOfStl(whole + std::string(49, '\0'), 12), "49 bytes after");
    expectOne(warningsOfStl(whole + std::string(120, 'x'), 12),
              "could be 2 triangles more than the header");
    EXPECT_THROW(parseStl(whole.substr(0, whole.size() - 1), "t"), FileError);
  }
}

TEST(RealStl, MissingCountIsTakenFromTheSize) {
  const TriangleMesh cube = box(Vec3(1, 1, 1));
  expectOne(warningsOfStl(binaryStl(cube, 0), 12), "the header says 0 triangles");
  expectOne(warningsOfStl(binaryStl(cube, 0xffffffff), 12), "read as 12");
  EXPECT_EQ(warningsOfStl(binaryStl(cube, 0) + "\n", 12).size(), 2u);
  EXPECT_THROW(parseStl(binaryStl({}, 0), "t"), FileError);
}

TEST(RealStl, ColorsAreReportedAsDropped) {
  expectOne(warningsOfStl(binaryStl(box(Vec3(1, 1, 1)), 12, "COLOR=\1\2\3\4"), 12), "colours");
  std::string own = binaryStl(box(Vec3(1, 1, 1)), 12);
  own[84 + 50 - 1] = '\x80'; // VisCAM: the attribute of a triangle says that it is a colour
  expectOne(warningsOfStl(own, 12), "colours");
}

const std::string kFacet = " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
                           "   vertex 0 1 0\n  endloop\n endfacet\n";

TEST(RealStl, AsciiOfManyProgramsIsRead) {
  const std::string text = "solid a\n" + kFacet + "endsolid a\n";
  EXPECT_TRUE(warningsOfStl(withCarriageReturns(text), 1).empty());
  std::string spaced = text, upper = text;
  for (const char* word : {"loop", "facet", "solid"})
    spaced.replace(spaced.find(std::string("end") + word), 3, "end ");
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_TRUE(warningsOfStl(spaced, 1).empty());
  EXPECT_TRUE(warningsOfStl(upper, 1).empty());
  EXPECT_TRUE(warningsOfStl(text + "\n\n" + spaced + upper, 3).empty());
  EXPECT_TRUE(warningsOfStl("solid empty\nendsolid\n" + text, 1).empty());
  EXPECT_TRUE(warningsOfStl(withCarriageReturns(text + upper), 2).empty());
}

TEST(RealStl, AsciiOfOneLineWithColorsOrWithoutItsEndIsRead) {
  const std::string text = "solid a part\n" + kFacet + kFacet + "endsolid a solid part\n";
  std::string line = text + text;
  std::replace(line.begin(), line.end(), '\n', ' ');
  EXPECT_TRUE(warningsOfStl(line, 4).empty());
  EXPECT_TRUE(warningsOfStl(text + text, 4).empty());
  expectOne(warningsOfStl("solid a\n" + kFacet, 1), "may have been cut off");
  EXPECT_THROW(parseStl("solid a\n", "t"), FileError);
  std::string colored = text;
  for (const char* before : {" facet", "   vertex", "  endloop", " endfacet", "endsolid"})
    colored.insert(colored.find(before), "color 1 0 0 0.5\n");
  expectOne(warningsOfStl(colored, 2), "colours of its triangles");
}

TEST(RealStl, TextAfterTheLastSolidIsIgnored) {
  const std::string text = "solid a\n" + kFacet + "endsolid a\n";
  for (const char* rest : {"garbage\n", "\x1a", "color 1 0 0\n", "endsolid\n"})
    expectOne(warningsOfStl(text + rest, 1), "line 10: what follows the last solid is left out");
  EXPECT_THROW(parseStl("solid a\nendsolid\ngarbage", "t"), FileError);
}

} // namespace
} // namespace patina
