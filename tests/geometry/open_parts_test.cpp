#include "geometry/sides/open_parts.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh/shapes.h"
#include "geometry/sides/pseudonormal_side.h"
#include "geometry/tree/triangle_tree.h"
#include "support/changed_mesh.h"
#include "support/mesh_defects.h"
#include "support/shared_data.h"

namespace patina {
namespace {

using test::inverted;
using test::moved;

// A sphere without its part above z = height.
TriangleMesh bowl(double radius, double height) {
  TriangleMesh mesh = icosphere(radius, 20);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    double z = 0;
    for (const std::int32_t v : t) z += mesh.positions[static_cast<std::size_t>(v)].z() / 3;
    return z > height;
  });
  return mesh;
}

TEST(OpenParts, AreAbsentInClosedMeshes) {
  for (const TriangleMesh& mesh :
       {icosphere(0.05, 10), torus(0.04, 0.015, 40, 20), box(Vec3(0.1, 0.05, 0.02), 3),
        inverted(icosphere(0.05, 10)), joined(icosphere(0.05, 10), icosphere(0.05, 10)),
        withFlippedFaces(icosphere(0.05, 10), 0.3, 1)})
    EXPECT_FALSE(openParts(mesh).any());
}

TEST(OpenParts, HolesAndCracksDoNotOpenABody) {
  for (unsigned seed : {1U, 2U, 3U}) {
    const TriangleMesh holed = withHoles(icosphere(0.05, 30), 12, 0.005, seed);
    EXPECT_FALSE(openParts(holed).any());
    EXPECT_FALSE(openParts(inverted(holed)).any());
    EXPECT_FALSE(openParts(withFlippedFaces(holed, 0.05, seed)).any());
  }
  EXPECT_FALSE(openParts(withShrunkenTriangles(icosphere(0.05, 10), 0.02)).any());
  EXPECT_FALSE(openParts(bowl(0.05, 0.045)).any());
}

TEST(OpenParts, SheetsAndBowlsAreOpen) {
  for (const TriangleMesh& mesh : {sheet(0.1, 0.1, 1), sheet(0.1, 0.1, 20), bowl(0.05, 0),
                                   bowl(0.05, -0.03), inverted(sheet(0.1, 0.1, 5))}) {
    const OpenParts open = openParts(mesh);
    EXPECT_EQ(open.parts, 1U);
    EXPECT_EQ(open.triangles, mesh.triangles.size());
  }
  const TriangleMesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}};
  EXPECT_EQ(openParts(one).triangles, 1U);
}

// Two sheets give a winding number like the upper face of one body and the lower one of another.
TEST(OpenParts, SheetsOneAboveTheOtherAreOpen) {
  for (const double gap : {0.0005, 0.005})
    for (const double size : {0.03, 0.06, 0.09, 0.1, 0.3}) {
      const TriangleMesh lower = sheet(0.1, 0.1, 10),
                         upper = moved(sheet(size, size, 10), Vec3(1e-3, 2e-3, gap));
      for (const TriangleMesh& mesh : {joined(lower, upper), inverted(joined(lower, upper))})
        EXPECT_EQ(openParts(mesh).triangles, 400U) << gap << ' ' << size;
      const TriangleMesh ball = withHoles(icosphere(0.02, 20), 3, 0.003, 1);
      EXPECT_EQ(openParts(joined(joined(lower, upper), moved(ball, Vec3(0, 0, 0.06)))).triangles,
                400U)
          << gap << ' ' << size;
    }
}

TEST(OpenParts, AreSeparatedInOneMesh) {
  const TriangleMesh ball = withHoles(icosphere(0.02, 20), 3, 0.003, 1);
  for (const double height : {0.0205, 0.05}) {
    const TriangleMesh mesh = joined(sheet(0.3, 0.3, 10), moved(ball, Vec3(0, 0, height)));
    const OpenParts open = openParts(mesh);
    EXPECT_EQ(open.parts, 1U);
    EXPECT_EQ(open.triangles, 200U);
    for (std::size_t f = 0; f < open.open.size(); ++f) EXPECT_EQ(open.open[f], f < 200);
  }
}

TEST(OpenParts, AreNamed) {
  EXPECT_EQ(describeSides(sideCounts(12, 0, OpenSides::one)), "closed");
  EXPECT_EQ(describeSides(sideCounts(12, 12, OpenSides::two)), "two-sided");
  EXPECT_EQ(describeSides(sideCounts(12, 2, OpenSides::one)),
            "10 triangles closed, 2 triangles one-sided");
}

TEST(OpenParts, ScanWithHolesStaysClosed) {
  const auto path = test::sharedData("meshes/plane_holes.obj");
  PATINA_SKIP_WITHOUT(path);
  const TriangleMesh mesh = readMesh(path);
  EXPECT_LT(openParts(mesh).triangles, mesh.triangles.size() / 100);
}

// A cone of many faces with a vertex as its tip, open below: of unit height over the unit disc.
TriangleMesh cone(int faces) {
  TriangleMesh mesh;
  mesh.positions.emplace_back(0, 0, 1);
  for (int i = 0; i < faces; ++i) {
    const double angle = 2 * std::numbers::pi * i / faces;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    mesh.triangles.push_back({0, i + 1, (i + 1) % faces + 1});
  }
  return mesh;
}

void expectSides(const TriangleMesh& mesh, const std::function<Side(const Vec3&)>& truth,
                 double reach) {
  const TriangleTree tree(mesh);
  const PseudonormalSide front(mesh, std::vector<std::uint8_t>(mesh.triangles.size(), 1));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-reach, reach);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p(unit(random), unit(random), unit(random));
    EXPECT_EQ(front.at(p, tree.closestPoint(p).surface.face), truth(p)) << p.transpose();
  }
}

TEST(PseudonormalSide, MatchesAPlaneOverAndBeyondASquare) {
  const auto truth = [](const Vec3& p) {
    if (std::max(std::abs(p.x()), std::abs(p.y())) > 1) return Side::beyond_boundary;
    return p.z() > 0 ? Side::front : Side::back;
  };
  for (const int cells : {1, 5}) expectSides(sheet(2, 2, cells), truth, 2);
  const TriangleMesh twice = joined(sheet(2, 2, 5), inverted(sheet(2, 2, 5)));
  expectSides(twice, truth, 2); // the first of two counts
}

// Points around a sharp tip lie on its front, points below on its back: no single face decides it.
TEST(PseudonormalSide, IsConstantAroundATip) {
  for (const int faces : {3, 7, 40}) {
    const TriangleMesh mesh = cone(faces);
    const TriangleTree tree(mesh);
    const PseudonormalSide front(mesh, std::vector<std::uint8_t>(mesh.triangles.size(), 1));
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    int above = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 p = Vec3(0, 0, 1) + 0.1 * Vec3(normal(random), normal(random), normal(random));
      // Inside: below every face's plane.
      bool inside = true;
      for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
        inside = inside && faceNormal(mesh, f).dot(p - Vec3(0, 0, 1)) < 0;
      above += !inside;
      EXPECT_EQ(front.at(p, tree.closestPoint(p).surface.face), inside ? Side::back : Side::front);
    }
    EXPECT_GT(above, 10000);
  }
}

} // namespace
} // namespace patina
