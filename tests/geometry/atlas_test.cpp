// Charts of an atlas are separate, embedded and little stretched.
#include <algorithm>
#include <map>
#include <numbers>
#include <random>

#include <tbb/global_control.h>

#include "geometry/atlas/texel_map.h"
#include "geometry/atlas_checks.h"
#include "geometry/mesh/shapes.h"
#include "support/mesh_defects.h"

namespace patina {
namespace {

using test::Corners, test::expectAtlas, test::share, test::spiralRamp;

// A fan that runs twice around one vertex before it closes.
TriangleMesh branchedDisc() {
  TriangleMesh mesh;
  mesh.positions.emplace_back(0, 0, 0);
  const int n = 24;
  for (int k = 0; k < 2 * n; ++k) {
    const double angle = 2 * std::numbers::pi * k / n;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.2 * std::cos(angle / 2));
    mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % (2 * n)});
  }
  return mesh;
}

// Two sheets of radius 1 and 2, cut along one line and joined crosswise there: neither boundary
// meets the other or itself, but both run twice around the ends of the line.
TriangleMesh crossedSheets() {
  constexpr int kLine = 2; // quads to either side of the middle
  TriangleMesh mesh;
  const auto add = [&](double x, double y, double z) {
    mesh.positions.emplace_back(x, y, z);
    return static_cast<std::int32_t>(mesh.positions.size()) - 1;
  };
  std::map<std::array<int, 2>, std::int32_t> on_line; // vertex by x and pair of sides
  for (const int radius : {8, 16}) {
    const int pair = radius == 8 ? 0 : 1;
    std::map<std::array<int, 2>, std::int32_t> others;
    const auto vertex = [&](int x, int y, bool above) {
      if (y != 0 || std::abs(x) > kLine) {
        const auto [at, fresh] = others.try_emplace({x, y}, 0);
        if (fresh) at->second = add(x, y, 0.1 * pair);
        return at->second;
      }
      const int joins = std::abs(x) == kLine ? 2 : above ? pair : 1 - pair;
      const auto [at, fresh] = on_line.try_emplace({x, joins}, 0);
      if (fresh) at->second = add(x, y, 0.05 + 0.01 * joins);
      return at->second;
    };
    for (int y = -radius; y < radius; ++y)
      for (int x = -radius; x < radius; ++x) {
        const bool above = y >= 0;
        const std::int32_t a = vertex(x, y, above), b = vertex(x + 1, y, above),
                           c = vertex(x + 1, y + 1, above), d = vertex(x, y + 1, above);
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      }
  }
  return mesh;
}

// Two faces on one side of an edge that both contain it in the same direction.
TriangleMesh openBook() {
  return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 1, 0), Vec3(0.5, 1, 0.3)},
          {{0, 1, 2}, {0, 1, 3}},
          {}};
}

// A flat wheel of needles around one vertex.
TriangleMesh wheel(int spokes) {
  TriangleMesh mesh;
  mesh.positions.emplace_back(0, 0, 0);
  for (int k = 0; k < spokes; ++k) {
    const double angle = 2 * std::numbers::pi * k / spokes;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % spokes});
  }
  return mesh;
}

TriangleMesh noisy(TriangleMesh mesh, double amplitude) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, amplitude);
  for (Vec3& p : mesh.positions) p += Vec3(noise(random), noise(random), noise(random));
  return mesh;
}

TriangleMesh rightTriangle() {
  return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.3, 0.7, 0.2)}, {{0, 1, 2}}, {}};
}

// Three sheets that meet in one line, and a finer one whose corners lie on another's edge.
TriangleMesh junctions() {
  TriangleMesh mesh = sheet(1, 1, 3);
  const TriangleMesh other = sheet(1, 1, 3);
  for (const double angle : {0.7, 2.0}) {
    Eigen::Affine3d turn(Eigen::Translation3d(-0.5, 0, 0) *
                         Eigen::AngleAxisd(angle, Vec3::UnitY()) * Eigen::Translation3d(0.5, 0, 0));
    mesh = joined(mesh, transformed(other, turn));
  }
  return joined(mesh, transformed(sheet(1, 1, 7), Eigen::Affine3d(Eigen::Translation3d(0, 1, 0))));
}

TEST(MadeAtlas, KeepsItsPromisesOnEveryKindOfMesh) {
  const std::vector<std::pair<const char*, TriangleMesh>> meshes = {
      {"triangle", rightTriangle()},
      {"sphere", icosphere(1, 8)},
      {"torus", torus(1, 0.4, 36, 18)},
      {"vase", vase(0.12, 0.004, 24, 12)},
      {"box", box(Vec3(1, 2, 3), 3)},
      {"turned box", transformed(box(Vec3(1, 2, 3), 3), Eigen::Affine3d(Eigen::AngleAxisd(
                                                            0.9, Vec3(1, 2, 3).normalized())))},
      {"rod", box(Vec3(1000, 1, 1), 3)},
      {"slab", box(Vec3(1000, 1000, 1), 3)},
      {"far away", transformed(icosphere(1, 5), Eigen::Affine3d(Eigen::Translation3d(1e6, 0, 0)))},
      {"tiny", icosphere(1e-6, 5)},
      {"needles", wheel(1000)},
      {"exact spiral", spiralRamp(5, 0.3, 0.1, 0)},
      {"widening spiral", spiralRamp(5, 0.3, 0.2, 0.13)},
      {"narrowing spiral", spiralRamp(5, 0.6, 0.3, 0.31)},
      {"steps round an axis", spiralRamp(4, 0, 0.2, 0)},
      {"flat spiral", spiralRamp(3, 0.3, 1e-6, 0)},
      {"branched", branchedDisc()},
      {"crossed sheets", crossedSheets()},
      {"open book", openBook()},
      {"junctions", junctions()},
      {"flipped faces", withFlippedFaces(icosphere(1, 5), 0.2, 3)},
      {"holes", withHoles(icosphere(1, 10), 12, 0.15, 2)},
      {"noise", noisy(icosphere(1, 8), 0.05)},
      {"soup", withShrunkenTriangles(icosphere(1, 3), 0.2)},
      {"galleon", galleon(1)},
  };
  for (const auto& [name, mesh] : meshes)
    for (const int size : {128, 512}) {
      if (size == 128 && mesh.triangles.size() > 3000) continue;
      SCOPED_TRACE(std::string(name) + " at " + std::to_string(size));
      const TextureLayout layout = generateAtlas(mesh, size);
      expectAtlas(mesh, layout, size);
    }
}

TEST(MadeAtlas, CutsASpiralOnceATurn) {
  const TextureLayout layout = generateAtlas(spiralRamp(20, 0.3, 0.1, 0), 512);
  EXPECT_GE(layout.charts, 20);
  EXPECT_LE(layout.charts, 48);
  EXPECT_EQ(generateAtlas(spiralRamp(0.99, 0.3, 0.1, 0), 512).charts, 1);
}

TEST(MadeAtlas, UsesFewChartsAndMuchOfTheImage) {
  EXPECT_EQ(generateAtlas(sheet(1, 1, 10), 512).charts, 1);
  EXPECT_GT(share(generateAtlas(sheet(1, 1, 10), 512)), 0.95);
  EXPECT_EQ(generateAtlas(wheel(5000), 512).charts, 1);
  const TextureLayout sphere = generateAtlas(icosphere(1, 20), 512);
  EXPECT_LE(sphere.charts, 8);
  EXPECT_GT(share(sphere), 0.5);
  EXPECT_GT(share(generateAtlas(galleon(1), 512)), 0.5);
  EXPECT_GT(share(generateAtlas(vase(), 512)), 0.5);
}

TEST(MadeAtlas, IndexCracksAreNoBorder) {
  TriangleMesh mesh = icosphere(1, 6), apart;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      if (k == 0)
        apart.triangles.push_back({static_cast<std::int32_t>(3 * f),
                                   static_cast<std::int32_t>(3 * f + 1),
                                   static_cast<std::int32_t>(3 * f + 2)});
      apart.positions.push_back(mesh.corner(f, k));
    }
  EXPECT_EQ(generateAtlas(apart, 256).charts, generateAtlas(mesh, 256).charts);
}

TEST(MadeAtlas, DuplicateFacesShareOnePlace) {
  const TriangleMesh mesh = icosphere(1, 10);
  TriangleMesh copy = mesh;
  for (Triangle& t : copy.triangles) t = {t[1], t[2], t[0]};
  const TextureLayout once = generateAtlas(mesh, 256),
                      twice = generateAtlas(joined(mesh, copy), 256);
  EXPECT_EQ(twice.charts, once.charts);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Corners& uv = (*once.uvs)[f];
    ASSERT_EQ((*twice.uvs)[f], uv);
    ASSERT_EQ((*twice.uvs)[f + mesh.triangles.size()], (Corners{uv[1], uv[2], uv[0]}));
  }
}

TEST(MadeAtlas, OppositeDuplicateFacesHaveSeparatePlaces) {
  for (const TriangleMesh& mesh : {sheet(1, 2, 8), icosphere(1, 6)}) {
    TriangleMesh back = mesh, both;
    for (Triangle& t : back.triangles) std::swap(t[1], t[2]);
    // Faces alternate, as in files of sheets that are visible from both sides.
    both.positions = mesh.positions;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      both.triangles.push_back(mesh.triangles[f]);
      both.triangles.push_back(back.triangles[f]);
    }
    const TextureLayout layout = generateAtlas(both, 256);
    EXPECT_LE(layout.charts, generateAtlas(mesh, 256).charts + generateAtlas(back, 256).charts);
    EXPECT_GT(share(layout), 0.4);
    for (std::size_t a = 0; a < both.triangles.size(); ++a)
      for (std::size_t b = a + 1; b < both.triangles.size(); ++b)
        ASSERT_GT(test::separation((*layout.uvs)[a], (*layout.uvs)[b]), -1e-11) << a << ' ' << b;
  }
}

TEST(MadeAtlas, FacesWithoutAreaGetAPointOfTheSurface) {
  TriangleMesh mesh = sheet(1, 1, 4);
  const std::size_t good = mesh.triangles.size();
  mesh.positions.emplace_back(Vec3(0, 0, 5)); // in no other face
  const auto lone = static_cast<std::int32_t>(mesh.positions.size() - 1);
  mesh.triangles.push_back({24, 24, 23}); // the sheet's last corner, which is no face's first one
  mesh.triangles.push_back({0, 1, 2});    // three in a row
  mesh.triangles.push_back({lone, lone, lone});
  const TextureLayout layout = generateAtlas(mesh, 128);
  for (std::size_t f = good; f < mesh.triangles.size(); ++f) {
    const Corners& point = (*layout.uvs)[f];
    EXPECT_EQ(point[0], point[1]);
    EXPECT_EQ(point[0], point[2]);
    bool own = false, any = false; // a corner of a face at one of its vertices, or of another
    for (std::size_t other = 0; other < good; ++other)
      for (std::size_t k = 0; k < 3; ++k) {
        const bool here = (*layout.uvs)[other][k] == point[0];
        const auto& vertices = mesh.triangles[f];
        any = any || here;
        own = own || (here && std::find(vertices.begin(), vertices.end(),
                                        mesh.triangles[other][k]) != vertices.end());
      }
    EXPECT_TRUE(any);
    EXPECT_EQ(own, mesh.triangles[f][0] != lone);
  }
  mesh.triangles.resize(good);
  expectAtlas(mesh, generateAtlas(mesh, 128), 128);
}

TEST(MadeAtlas, MeshesWithoutAnyAreaAndEmptyOnesAreFinite) {
  EXPECT_TRUE(generateAtlas({}, 64).uvs->empty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const TriangleMesh mesh = {
      {Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(nan, 0, 0)}, {{0, 0, 1}, {0, 1, 2}, {1, 1, 1}}, {}};
  const TextureLayout layout = generateAtlas(mesh, 64);
  EXPECT_EQ(layout.charts, 0);
  for (const Corners& uv : *layout.uvs)
    for (const Vec2& p : uv) EXPECT_TRUE(p.allFinite());
}

TEST(MadeAtlas, TakesSizesFrom16To16384) {
  EXPECT_THROW(generateAtlas(rightTriangle(), 15), std::invalid_argument);
  EXPECT_THROW(generateAtlas(rightTriangle(), 16385), std::invalid_argument);
  expectAtlas(rightTriangle(), generateAtlas(rightTriangle(), 16), 16);
  expectAtlas(rightTriangle(), generateAtlas(rightTriangle(), 16384), 16384);
  expectAtlas(box(Vec3(1, 1, 1)), generateAtlas(box(Vec3(1, 1, 1)), 32), 32);
}

// More pieces than the image has texels: the smallest share the texels of their neighbours.
TEST(MadeAtlas, StaysInTheImageWithMorePiecesThanTexels) {
  for (const TriangleMesh& mesh :
       {withShrunkenTriangles(icosphere(1, 30), 0.2), noisy(icosphere(1, 30), 0.2)}) {
    const TextureLayout layout = generateAtlas(mesh, 32);
    EXPECT_GE(layout.charts, 1);
    const TexelMap map = texelMap(*layout.uvs, 32, 32);
    for (const Corners& uv : *layout.uvs) {
      for (const Vec2& p : uv) {
        ASSERT_GE(p.minCoeff(), 0);
        ASSERT_LE(p.maxCoeff(), 1);
      }
      const Vec2 p = (uv[0] + uv[1] + uv[2]) / 3 * 32;
      ASSERT_GE(
          map.ownerAt(std::min(31, static_cast<int>(p[0])), std::min(31, static_cast<int>(p[1]))),
          0);
    }
  }
}

TEST(MadeAtlas, ChartsOfSubTexelFacesHoldMany) {
  const TriangleMesh mesh = icosphere(1, 80); // 128,000 faces, 10 a texel
  const TextureLayout layout = generateAtlas(mesh, 128);
  EXPECT_LE(layout.charts, 8);
  EXPECT_GT(share(layout), 0.4);
}

TEST(MadeAtlas, IsTheSameWithOneThread) {
  const TriangleMesh mesh = noisy(galleon(1), 1e-3);
  const TextureLayout many = generateAtlas(mesh, 512);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const TextureLayout alone = generateAtlas(mesh, 512);
  ASSERT_EQ(alone.uvs->size(), many.uvs->size());
  for (std::size_t f = 0; f < many.uvs->size(); ++f) ASSERT_EQ((*alone.uvs)[f], (*many.uvs)[f]);
}

} // namespace
} // namespace patina
