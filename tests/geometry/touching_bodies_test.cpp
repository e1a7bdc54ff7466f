// Bodies that touch are counted by place: the same whether they share vertices or not.
#include <gtest/gtest.h>

#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/shapes.h"
#include "geometry/sides/inner_faces.h"
#include "geometry/sides/open_parts.h"
#include "support/changed_mesh.h"

namespace patina {
namespace {

using test::moved;

TriangleMesh cubesAt(const std::vector<Vec3>& places) {
  TriangleMesh all;
  for (const Vec3& place : places) append(all, moved(box(Vec3::Ones()), place));
  return all;
}

struct Touching {
  TriangleMesh mesh; // each body with vertices of its own
  std::size_t components, non_manifold, duplicate = 0, inner = 0, holes = 0;
};

// A wall between two cubes is two triangles, twice; its four edges have one face more on each side.
std::vector<Touching> configurations() {
  std::vector<Vec3> board; // the even cells of 3 x 3 x 3: each of 3 x 3 x 4 inner edges has two
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x)
        if ((x + y + z) % 2 == 0) board.emplace_back(x, y, z);
  TriangleMesh open = cubesAt({Vec3::Zero(), Vec3(0, 1, -1)}); // touching below the missing lid
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](std::int32_t v) { return open.positions[index(v)].z() == 0.5; });
  });
  return {{cubesAt({Vec3::Zero(), Vec3(3, 0, 0)}), 2, 0},
          {cubesAt({Vec3::Zero(), Vec3(1, 1, 1)}), 1, 0},
          {cubesAt({Vec3::Zero(), Vec3(1, 1, 0)}), 1, 1},
          {cubesAt({Vec3::Zero(), Vec3(1, 0, 0)}), 1, 4, 2, 4},
          {cubesAt({Vec3::Zero(), Vec3(1, 0, 0), Vec3(2, 0, 0)}), 1, 8, 4, 8},
          {cubesAt({Vec3::Zero(), Vec3(1, 1, 0), Vec3(5, 5, 5), Vec3(6, 6, 6)}), 2, 1},
          {cubesAt({Vec3::Zero(), Vec3(0.5, 1, 0)}), 2, 0}, // across half a side: no common vertex
          {cubesAt(board), 1, 36},
          {open, 1, 1, 0, 0, 1}};
}

TEST(TouchingBodies, AreCountedByPlace) {
  const std::vector<Touching> cases = configurations();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Touching& wanted = cases[i];
    const TriangleMesh welded{wanted.mesh.positions, weldedTriangles(wanted.mesh), {}};
    for (const TriangleMesh& mesh : {wanted.mesh, welded, withShrunkenTriangles(wanted.mesh, 0)}) {
      const MeshReport report = inspect(mesh);
      EXPECT_EQ(report.components, wanted.components) << i;
      EXPECT_EQ(report.non_manifold_edges, wanted.non_manifold) << i;
      EXPECT_EQ(report.duplicate, wanted.duplicate) << i;
      EXPECT_EQ(report.boundary_edges, 4 * wanted.holes) << i;
      EXPECT_EQ(report.misoriented_edges, 0U) << i;
      EXPECT_EQ(report.watertight, wanted.non_manifold + wanted.holes == 0) << i;
      const OpenParts found = openParts(mesh);
      EXPECT_EQ(found.inner_triangles, wanted.inner) << i;
      EXPECT_FALSE(found.any()) << i;
      EXPECT_EQ(found.decided.size(), wanted.holes) << i;
      ASSERT_EQ(found.holes.size(), wanted.holes) << i;
      for (const Hole& hole : found.holes) {
        EXPECT_NEAR(hole.area, 1, 1e-12);
        EXPECT_NEAR((hole.centre - Vec3(0, 0, 0.5)).norm(), 0, 1e-12);
      }
    }
  }
}

} // namespace
} // namespace patina
