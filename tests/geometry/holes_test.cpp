#include "geometry/mesh/holes.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"
#include "geometry/sides/inner_faces.h"
#include "geometry/sides/open_parts.h"
#include "support/changed_mesh.h"
#include "support/loose_triangles.h"

namespace patina {
namespace {

using test::inverted;
using test::loose;
using test::moved;

template <class Drop> TriangleMesh without(TriangleMesh mesh, const Drop& drop) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    Vec3 centre = Vec3::Zero();
    for (const std::int32_t v : t) centre += mesh.positions[static_cast<std::size_t>(v)] / 3;
    return drop(centre);
  });
  return mesh;
}

void expectHole(const Hole& hole, double area, const Vec3& centre, double tolerance) {
  EXPECT_NEAR(hole.area, area, tolerance * area);
  EXPECT_LE((hole.centre - centre).norm(), tolerance * std::sqrt(area));
}

TEST(Holes, AreExactForFlatLoops) {
  const std::vector<Vec3> ell{{0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}, {1, 3, 1}, {0, 3, 1}};
  expectHole(spanned(ell), 4, Vec3(0.75, 1.25, 1), 1e-12);
  std::vector<Vec3> circle;
  for (int i = 0; i < 1000; ++i)
    circle.emplace_back(std::cos(2 * std::numbers::pi * i / 1000), 0,
                        std::sin(2 * std::numbers::pi * i / 1000));
  expectHole(spanned(circle), std::numbers::pi, Vec3::Zero(), 1e-4);
}

// Two squares that meet at a right angle.
TEST(Holes, AreTheMinimalTriangulationOfNonPlanarLoops) {
  const std::vector<Vec3> bent{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}, {0, 1, 0}};
  expectHole(spanned(bent), 2, Vec3(0.5, 0.75, 0.25), 1e-12);
}

TEST(Holes, AreSeparateIfTheyTouch) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-2, 0, 0}, {0, -2, 0}};
  const auto holes = holesOf(points, {{{0, 1}}, {{1, 2}}, {{2, 0}}, {{0, 3}}, {{3, 4}}, {{4, 0}}});
  ASSERT_EQ(holes.size(), 2U);
  EXPECT_DOUBLE_EQ(holes[0].area, 2);
  EXPECT_DOUBLE_EQ(holes[1].area, 0.5);
}

TEST(Holes, AreReportedForAnOpenBoxAndARoom) {
  const TriangleMesh open =
      without(box(Vec3(0.1, 0.08, 0.06), 10), [](const Vec3& p) { return p.z() > 0.0299; });
  const TriangleMesh room = without(box(Vec3(4, 3, 2.5), 20), [](const Vec3& p) {
    return p.x() > 1.999 && std::abs(p.y()) < 0.75 && p.z() < 0.5;
  });
  for (const bool turned : {false, true}) {
    const OpenParts lid = openParts(turned ? inverted(open) : open);
    ASSERT_EQ(lid.holes.size(), 1U);
    expectHole(lid.holes[0], 0.008, Vec3(0, 0, 0.03), 1e-9);
    EXPECT_EQ(lid.holes[0].edges, 40U);
    const OpenParts door = openParts(turned ? inverted(room) : room);
    ASSERT_EQ(door.holes.size(), 1U);
    expectHole(door.holes[0], 1.5 * 1.75, Vec3(2, 0, -0.375), 1e-9);
  }
  EXPECT_TRUE(openParts(sheet(0.1, 0.1, 5)).holes.empty()); // no hole is closed
}

// The centroid of an L with long legs lies outside of it.
TEST(Holes, AreReportedWhoseCentroidLiesOffThem) {
  const std::vector<Vec3> ell{{0, 0, 0},       {0.05, 0, 0},    {0.05, 0.01, 0},
                              {0.01, 0.01, 0}, {0.01, 0.05, 0}, {0, 0.05, 0}};
  TriangleMesh prism;
  for (const double z : {0., 0.03})
    for (const Vec3& p : ell) prism.positions.push_back(p + Vec3(0, 0, z));
  for (std::int32_t i = 0; i < 6; ++i) {
    const std::int32_t j = (i + 1) % 6;
    prism.triangles.push_back({i, j, i + 6});
    prism.triangles.push_back({j, j + 6, i + 6});
  }
  for (const Triangle& t : {Triangle{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 5, 4}})
    prism.triangles.push_back(t);
  const OpenParts found = openParts(prism);
  ASSERT_EQ(found.holes.size(), 1U);
  const double at = (5e-4 * 0.025 + 4e-4 * 0.005) / 9e-4;
  expectHole(found.holes[0], 9e-4, Vec3(at, at, 0.03), 1e-9);
}

TEST(Holes, ExcludeGapsBetweenLooseTriangles) {
  const TriangleMesh open =
      without(box(Vec3(0.1, 0.08, 0.06), 40), [](const Vec3& p) { return p.z() > 0.0299; });
  const OpenParts found = openParts(loose(open, 5e-5), OpenSides::automatic, 1e-3);
  EXPECT_EQ(found.triangles, 0U);
  ASSERT_FALSE(found.holes.empty());
  expectHole(found.holes[0], 0.008, Vec3(0, 0, 0.03), 0.01);
}

// A crack around a ball has a boundary as long as an equator, but what it spans is inside.
TEST(Holes, ExcludeACrackAroundABody) {
  const auto half = [](double up) {
    return moved(without(icosphere(0.04, 20), [&](const Vec3& p) { return up * p.z() < 0; }),
                 Vec3(0, 0, 2.5e-5 * up));
  };
  const TriangleMesh cracked = joined(half(1), half(-1));
  EXPECT_FALSE(openParts(cracked).any());
  EXPECT_TRUE(openParts(cracked).holes.empty());
  const TriangleMesh cut = without(icosphere(0.04, 20), [](const Vec3& p) { return p.z() > 0.02; });
  EXPECT_EQ(openParts(cut).holes.size(), 1U);
}

TEST(InnerFaces, AreThoseSharedByTwoBodies) {
  const TriangleMesh one = box(Vec3::Ones(), 2), two = moved(one, Vec3(1, 0, 0));
  EXPECT_EQ(innerFaces(joined(one, two)).size(), 16U);
  EXPECT_TRUE(innerFaces(one).empty());
  EXPECT_TRUE(innerFaces(joined(one, inverted(one))).empty());
  EXPECT_TRUE(innerFaces(joined(one, moved(one, Vec3(1.1, 0, 0)))).empty());
  // A duplicate sheet that sticks out of a body is visible from outside.
  const TriangleMesh fin = moved(sheet(1, 1, 2), Vec3(1, 0, 0));
  EXPECT_TRUE(innerFaces(joined(one, joined(fin, inverted(fin)))).empty());
}

// The edges form loops around the whole body by chance.
TEST(Holes, AreAbsentBetweenLoosePieces) {
  const double voxel = 0.001;
  for (const TriangleMesh& body : {torus(0.04, 0.015, 120, 60), icosphere(0.05, 40)})
    for (const double shift : {0.01, 0.1, 0.3})
      for (const Hole& hole :
           openParts(loose(body, shift * voxel), OpenSides::automatic, voxel).holes)
        EXPECT_LT(hole.area, 25 * voxel * voxel) << shift;
}

} // namespace
} // namespace patina
