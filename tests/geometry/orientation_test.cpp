#include "geometry/mesh/orientation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"
#include "support/changed_mesh.h"

namespace patina {
namespace {

using test::inverted;
using test::moved;

TriangleMesh turned(TriangleMesh mesh, const std::vector<std::int32_t>& faces) {
  for (const std::int32_t f : faces) {
    Triangle& t = mesh.triangles[static_cast<std::size_t>(f)];
    std::swap(t[1], t[2]);
  }
  return mesh;
}

TEST(Orientation, ValidMeshesStayUnchanged) {
  const TriangleMesh ball = icosphere(0.05, 6);
  for (const TriangleMesh& mesh :
       {ball, inverted(ball), box(Vec3(1, 2, 3), 4), torus(0.04, 0.015, 20, 10), sheet(0.1, 0.1, 5),
        joined(ball, inverted(icosphere(0.03, 5))), // a cavity
        inverted(joined(ball, inverted(icosphere(0.03, 5)))), joined(ball, ball),
        joined(ball, inverted(ball)), TriangleMesh{}})
    EXPECT_TRUE(misorientedTriangles(mesh).empty());
}

TEST(Orientation, FlipsTheMinorityOfFaces) {
  const std::vector<std::int32_t> some{3, 4, 17, 40};
  for (const TriangleMesh& mesh :
       {icosphere(0.05, 4), inverted(icosphere(0.05, 4)), sheet(0.1, 0.1, 5)})
    EXPECT_EQ(misorientedTriangles(turned(mesh, some)), some);
}

TEST(Orientation, ClosedPartsFaceLikeMostOfTheVolume) {
  const TriangleMesh large = icosphere(0.05, 4);
  const TriangleMesh small = moved(icosphere(0.03, 4), Vec3(0.05, 0, 0));
  const auto first = static_cast<std::int32_t>(large.triangles.size());
  for (const auto& mesh : {joined(large, inverted(small)), joined(inverted(large), small)}) {
    const auto wrong = misorientedTriangles(mesh);
    ASSERT_EQ(wrong.size(), small.triangles.size());
    EXPECT_EQ(wrong.front(), first);
  }
}

// A cavity flips with the body that contains it.
TEST(Orientation, CavitiesStayCavities) {
  const TriangleMesh hollow = joined(icosphere(0.05, 4), inverted(icosphere(0.02, 4)));
  const TriangleMesh large = moved(icosphere(0.08, 4), Vec3(0.2, 0, 0));
  EXPECT_EQ(misorientedTriangles(joined(large, inverted(hollow))).size(), hollow.triangles.size());
}

TEST(Orientation, OneSidedBandsStayUnchanged) {
  TriangleMesh band; // Moebius strip: the last pair of vertices meets the first one swapped
  const int n = 12;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n;
    const Vec3 out(std::cos(a), std::sin(a), 0);
    const Vec3 along = 0.2 * (std::cos(a / 2) * out + std::sin(a / 2) * Vec3::UnitZ());
    band.positions.push_back(out - along);
    band.positions.push_back(out + along);
  }
  for (int i = 0; i < n; ++i) {
    const int a = 2 * i, b = a + 1;
    const int c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    band.triangles.push_back({a, b, c});
    band.triangles.push_back({b, d, c});
  }
  EXPECT_TRUE(misorientedTriangles(turned(band, {5, 6})).empty());
}

} // namespace
} // namespace patina
