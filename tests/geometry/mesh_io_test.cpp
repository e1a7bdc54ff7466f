// Reading and writing meshes: accepted forms, and no loss of data.
#include <clocale>
#include <cmath>
#include <cstring>
#include <limits>
#include <locale>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/file.h"
#include "core/numbers.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/shapes.h"
#include "support/fresh_folder.h"
#include "support/least_time.h"
#include "support/mesh_defects.h"
#include "support/shared_data.h"

namespace patina {
namespace {

const std::string kTriangleObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

std::string plyHeader(const std::string& format, std::size_t vertices, std::size_t faces) {
  return "ply\nformat " + format + " 1.0\ncomment by a test\nelement vertex " +
         std::to_string(vertices) + "\nproperty float x\nproperty float y\nproperty float z\n" +
         "element face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

template <typename T> void append(std::string& out, T value, bool big_endian = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian) std::reverse(raw, raw + sizeof(T));
  out.append(raw, sizeof(T));
}

class MeshFile : public testing::Test {
 protected:
  void SetUp() override { folder_ = test::freshFolder("mesh_io"); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  TriangleMesh throughFile(const TriangleMesh& mesh, const char* name) {
    writeMesh(folder_ / name, mesh);
    return readMesh(folder_ / name);
  }
  std::filesystem::path folder_;
};

TEST(ObjReader, UnderstandsEveryFormOfCorner) {
  const std::vector<Triangle> expected = {{0, 1, 2}};
  const std::string rest = "vt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n";
  for (const char* face : {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//1 3//1", "f 1/1/1 2/2/1 3/3/1",
                           "f -3 -2 -1", "f -3/-3/-1 -2/-2/-1 -1/-1/-1", "f  1\t2  3  # last",
                           "f 1/ 2/ 3/", "f 1/1/ 2/2/ 3/3/", "f \\\n1 2 \\\n3"}) {
    SCOPED_TRACE(face);
    EXPECT_EQ(parseObj(kTriangleObj + rest + face + "\n", "t").triangles, expected);
  }
}

TEST(ObjReader, ReadsTheSameWithEitherLineEndAndWithoutTheLast) {
  std::string unix_text = "# a comment\no thing\n" + kTriangleObj + "f 1 2 \\\n3";
  std::string dos_text;
  for (const char c : unix_text) dos_text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const TriangleMesh a = parseObj(unix_text, "unix"), b = parseObj(dos_text, "dos");
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.triangles.size(), 1u);
}

TEST(ObjReader, SkipsOtherElements) {
  const TriangleMesh mesh = parseObj("\xEF\xBB\xBFmtllib a.mtl\nh 1 2\nunknown statement\n"
                                     "g caf\xC3\xA9\ns off\nusemtl x\nl 1 2\np 1\n\n   \n" +
                                         kTriangleObj + "vp 1\nf 1 2 3\n",
                                     "t");
  EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST(ObjReader, SplitsPolygonsAndKeepsTheirTexture) {
  std::string text;
  for (int i = 0; i < 5; ++i)
    text += "v " + std::to_string(i) + " " + std::to_string(i * i) + " 0\nvt 0." +
            std::to_string(i) + " 0.5\n";
  const TriangleMesh mesh = parseObj(text + "f 1/1 2/2 3/3 4/4 5/5\n", "t");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
  ASSERT_EQ(mesh.corner_uvs.size(), 3u);
  EXPECT_EQ(mesh.corner_uvs[2][1], Vec2(0.3, 0.5));
}

TEST(ObjReader, DropsTextureThatSomeFaceLacks) {
  const TriangleMesh mesh =
      parseObj(kTriangleObj + "vt 0 0\nf 1/1 2/1 3/1\nf 1 3 2\nf 1/1 2/1 3/1\n", "t");
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_TRUE(mesh.corner_uvs.empty());
}

TEST(ObjReader, FaceMayUseLaterVertices) {
  EXPECT_EQ(parseObj("f 1 2 3\n" + kTriangleObj, "t").triangles.size(), 1u);
}

TEST(ObjReader, KeepsNonFiniteAndDegenerateForTheReport) {
  const TriangleMesh mesh =
      parseObj("v nan 0 0\nv 1 -inf 0\nv 0 1 Infinity\nv +1 1e-3 -.5\nf 1 2 3\nf 4 4 4\n", "t");
  EXPECT_TRUE(std::isnan(mesh.positions[0][0]));
  EXPECT_EQ(mesh.positions[1][1], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(mesh.positions[2][2], std::numeric_limits<double>::infinity());
  EXPECT_EQ(mesh.positions[3], Vec3(1, 1e-3, -0.5));
  EXPECT_EQ(inspect(mesh).non_finite, 1u);
  EXPECT_EQ(inspect(mesh).degenerate, 1u);
}

struct CommaPunctuation : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

TEST(ObjReader, IgnoresTheLocale) {
  const std::string c_before = std::setlocale(LC_NUMERIC, nullptr);
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new CommaPunctuation));
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) // locales that may be installed
    if (std::setlocale(LC_NUMERIC, name)) break;
  const TriangleMesh mesh = parseObj("v 0.25 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "t");
  std::locale::global(before);
  std::setlocale(LC_NUMERIC, c_before.c_str());
  EXPECT_EQ(mesh.positions[0][0], 0.25);
}

TEST(ObjReader, KeepsAllBitsFarFromTheOrigin) {
  const TriangleMesh mesh =
      parseObj("v 1000000.1234567891 0 0\nv 1000001 0 0\nv 1000000 1 4.9e-324\nf 1 2 3\n", "t");
  EXPECT_EQ(mesh.positions[0][0], 1000000.1234567891);
  EXPECT_EQ(mesh.positions[2][2], 4.9e-324);
}

TEST(PlyReader, AsciiAndBothBinaryOrdersAgree) {
  const TriangleMesh shape = torus(2, 0.5, 12, 8);
  std::string ascii = plyHeader("ascii", shape.positions.size(), shape.triangles.size());
  std::string little =
      plyHeader("binary_little_endian", shape.positions.size(), shape.triangles.size());
  std::string big = plyHeader("binary_big_endian", shape.positions.size(), shape.triangles.size());
  for (const Vec3& p : shape.positions) {
    for (int k = 0; k < 3; ++k) {
      const auto v = static_cast<float>(p[k]);
      ascii += formatNumber(v) + " ";
      append(little, v);
      append(big, v, true);
    }
    ascii += "\r\n\n";
  }
  for (const Triangle& t : shape.triangles) {
    ascii += "3";
    little += '\3';
    big += '\3';
    for (const std::int32_t v : t) {
      ascii += " " + std::to_string(v);
      append(little, v);
      append(big, v, true);
    }
    ascii += "\n";
  }
  const TriangleMesh a = parsePly(ascii, "a"), l = parsePly(little, "l"), b = parsePly(big, "b");
  EXPECT_EQ(a.triangles, shape.triangles);
  EXPECT_EQ(l.triangles, shape.triangles);
  EXPECT_EQ(b.triangles, shape.triangles);
  EXPECT_EQ(a.positions, l.positions);
  EXPECT_EQ(l.positions, b.positions);
  EXPECT_LT((a.positions[17] - shape.positions[17]).norm(), 1e-6);
}

TEST(PlyReader, SkipsUnknownListsAndElementsAnywhere) {
  const TriangleMesh mesh =
      parsePly("ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement camera 1\r\nproperty float f\r\n"
               "property list int double k\r\nelement face 1\r\nproperty uchar red\r\n"
               "property list uchar float quality\r\nproperty list ushort uint vertex_index\r\n"
               "element vertex 4\r\nproperty list uchar uchar tags\r\nproperty double z\r\n"
               "property int y\r\nproperty float x\r\nelement nothing 7\r\nelement tail 1\r\n"
               "property short s\r\nend_header\r\n"
               "35.0 2 1.5 2.5\r\n255 0 4 0 1 2 3\r\n"
               "0 3 2 1\r\n2 9 9 0 0 0\r\n0 0 0 1\r\n1 7 0 1 1\r\n-5\r\n",
               "t");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{1, 2, 3}, {3, 0, 1}})); // the smaller fold
  EXPECT_EQ(mesh.positions[0], Vec3(1, 2, 3));
}

TEST(PlyReader, TextureOfVerticesAndOfFacesIsKept) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                           "property float y\nproperty float z\n";
  const TriangleMesh by_vertex =
      parsePly(head + "property float s\nproperty float t\nelement face 1\n"
                      "property list uchar int vertex_indices\nend_header\n"
                      "0 0 0 0.5 0.25\n1 0 0 1 0\n0 1 0 0 1\n3 2 1 0\n",
               "t");
  ASSERT_EQ(by_vertex.corner_uvs.size(), 1u);
  EXPECT_EQ(by_vertex.corner_uvs[0][2], Vec2(0.5, 0.25));
  const TriangleMesh by_face =
      parsePly(head + "element face 1\nproperty list uchar int vertex_indices\n"
                      "property list uchar float texcoord\nend_header\n"
                      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0.5 1\n",
               "t");
  ASSERT_EQ(by_face.corner_uvs.size(), 1u);
  EXPECT_EQ(by_face.corner_uvs[0][2], Vec2(0.5, 1));
}

std::string stlOf(const TriangleMesh& mesh, const std::string& header) {
  std::string out = header;
  out.resize(80, ' ');
  append(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) append(out, 0.f);
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) append(out, static_cast<float>(mesh.corner(t, c)[k]));
    append(out, std::uint16_t{0});
  }
  return out;
}

TEST(StlReader, BinaryHeaderMayBeginWithSolid) {
  const TriangleMesh shape = icosphere(1, 3);
  const TriangleMesh mesh = parseStl(stlOf(shape, "solid in name only"), "t");
  EXPECT_EQ(mesh.triangles.size(), shape.triangles.size());
  EXPECT_EQ(mesh.positions.size(), shape.positions.size());
  EXPECT_TRUE(inspect(mesh).watertight);
}

TEST(StlReader, AsciiIsReadInAnyCaseAndWithSeveralSolids) {
  const std::string solid = "SOLID a name of words\n  Facet Normal 0 0 nan\n outer LOOP\n"
                            "vertex 0 0 0\nvertex 1e0 0 0\nvertex 0 1 0 endloop endfacet\n"
                            "endsolid a name of words\n";
  const TriangleMesh mesh = parseStl("\n" + solid + "\r\n" + solid, "t");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}}));
}

TEST(StlReader, WeldsTheTwoZerosAndNothingElse) {
  TriangleMesh soup;
  soup.positions = {Vec3(0.0, 0, 0),     Vec3(1, 0, 0), Vec3(0, 1, 0),
                    Vec3(-0.0, 0, -0.0), Vec3(0, 1, 0), Vec3(std::nextafter(1.f, 2.f), 0, 0)};
  soup.triangles = {{0, 1, 2}, {3, 4, 5}};
  const TriangleMesh mesh = parseStl(stlOf(soup, ""), "t");
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.triangles[1], (Triangle{0, 2, 3}));
}

// The weld grows its table: many more vertices than expected must stay distinct.
TEST(StlReader, KeepsAllVerticesOfATriangleSoup) {
  const TriangleMesh soup = withShrunkenTriangles(icosphere(1, 20), 0.3);
  const TriangleMesh mesh = parseStl(stlOf(soup, ""), "t");
  EXPECT_EQ(mesh.positions.size(), soup.positions.size());
  EXPECT_EQ(mesh.triangles, soup.triangles);
}

TEST_F(MeshFile, PlyAndObjReadBackBitForBit) {
  TriangleMesh mesh = transformed(torus(0.02, 0.007, 30, 12),
                                  Eigen::Affine3d(Eigen::Translation3d(1234.5, -0.1, 1e-12)));
  mesh.positions[3][1] = 4.9e-324;
  mesh.positions[4][2] = -0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double u = 0.1 * static_cast<double>(t % 40);
    mesh.corner_uvs.push_back({Vec2(u, 1. / 3), Vec2(u + 0.1, 0), Vec2(0, u)});
  }
  for (const char* name : {"a.ply", "b.OBJ"}) {
    SCOPED_TRACE(name);
    const TriangleMesh back = throughFile(mesh, name);
    EXPECT_EQ(back.triangles, mesh.triangles);
    ASSERT_EQ(back.positions.size(), mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      ASSERT_EQ(std::memcmp(&back.positions[v], &mesh.positions[v], sizeof(Vec3)), 0) << v;
    EXPECT_EQ(back.corner_uvs, mesh.corner_uvs);
  }
}

TEST_F(MeshFile, StlReadsBackAsTheSameClosedSurface) {
  const TriangleMesh mesh = vase();
  const TriangleMesh back = throughFile(mesh, "v.Stl");
  ASSERT_EQ(back.triangles.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      ASSERT_EQ(back.corner(t, k).cast<float>(), mesh.corner(t, k).cast<float>());
  EXPECT_TRUE(inspect(back).watertight);
}

TEST_F(MeshFile, NonFiniteCoordinatesSurvive) {
  TriangleMesh mesh = box(Vec3(1, 1, 1));
  mesh.positions[0] = Vec3(std::nan(""), HUGE_VAL, -HUGE_VAL);
  for (const char* name : {"a.ply", "a.obj", "a.stl"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(inspect(throughFile(mesh, name)).non_finite, inspect(mesh).non_finite);
  }
}

// Unit: one pass over the file's bytes, each multiplied into a product that depends on the last
// one: 1.44, 0.84 and 1.19 measured.
PATINA_TIMED_TEST(MeshFileTiming, MillionTrianglesAreReadInAFewPassesOfTheirBytes) {
  const TriangleMesh mesh = icosphere(0.05, 224);
  const auto path =
      std::filesystem::temp_directory_path() / ("patina_mesh_timing_" + std::to_string(getpid()));
  struct Row {
    const char* ending;
    double most;
  };
  for (const auto& [ending, most] : {Row{".obj", 4}, Row{".ply", 2.5}, Row{".stl", 3.5}}) {
    const std::filesystem::path file = path.string() + ending;
    writeMesh(file, mesh);
    volatile std::uint64_t kept = 0;
    const std::vector<double> seconds = test::minSeconds(
        {[&] { EXPECT_EQ(readMesh(file).triangles.size(), mesh.triangles.size()); },
         [&] {
           std::uint64_t product = 1;
           for (const char c : readFile(file))
             product = (product ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
           kept = product;
         }},
        2, 8);
    EXPECT_TRUE(test::within(ending, seconds[0], seconds[1], most));
    std::filesystem::remove(file);
  }
}

struct Scan {
  const char* file;
  std::size_t triangles, boundary_edges;
};

TEST(RealMeshes, AreReadWhole) {
  for (const Scan& scan : {Scan{"meshes/goathead.obj", 5522, 0}, Scan{"meshes/boat.obj", 32416, 0},
                           Scan{"meshes/plane_holes.obj", 16747, 341}}) {
    const std::filesystem::path path = test::sharedData(scan.file);
    PATINA_SKIP_WITHOUT(path);
    const MeshReport report = inspect(readMesh(path));
    EXPECT_EQ(report.triangles, scan.triangles) << scan.file;
    EXPECT_EQ(report.boundary_edges, scan.boundary_edges) << scan.file;
    EXPECT_EQ(report.watertight, scan.boundary_edges == 0) << scan.file;
  }
}

// Counterpart of the above on our own shapes.
TEST_F(MeshFile, ClosedAndHoledShapesKeepTheirReportThroughAFile) {
  for (const TriangleMesh& mesh :
       {vase(), galleon(0.3), withHoles(icosphere(0.05, 20), 4, 0.006, 1)}) {
    const MeshReport before = inspect(mesh);
    const MeshReport after = inspect(throughFile(mesh, "m.obj"));
    EXPECT_EQ(after.triangles, before.triangles);
    EXPECT_EQ(after.boundary_edges, before.boundary_edges);
    EXPECT_EQ(after.non_manifold_edges, before.non_manifold_edges);
    EXPECT_EQ(after.watertight, before.watertight);
  }
}

} // namespace
} // namespace patina
