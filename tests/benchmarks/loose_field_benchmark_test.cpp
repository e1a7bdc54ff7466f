// The field of triangles that do not join against that of the same mesh with shared vertices.
#include <gtest/gtest.h>

#include "field/construction/build_field.h"
#include "geometry/mesh/shapes.h"
#include "support/least_time.h"
#include "support/loose_triangles.h"
#include "support/one_thread.h"

namespace patina {
namespace {

PATINA_TIMED_TEST(LooseFieldTiming, IsAFewTenthsAboveThatOfAWeldedMesh) {
  const test::OneThread alone;
  const TriangleMesh welded = torus(0.04, 0.015, 240, 120);
  const FieldSpec spec;
  const double voxel = gridAround(bounds(welded), spec).voxel;
  const auto build = [&](const TriangleMesh& mesh) {
    Progress progress;
    (void)buildField(mesh, spec, progress);
  };
  std::vector<test::Work> works{[&] { build(welded); }};
  for (const double shift : {0.01, 0.03, 0.1, 0.3})
    works.emplace_back([&, mesh = test::loose(welded, shift * voxel)] { build(mesh); });
  const std::vector<double> seconds = test::minSeconds(works, 1);
  EXPECT_TRUE(test::within("triangles shifted by 0.01 voxel", seconds[1], seconds[0], 1.3));
  EXPECT_TRUE(test::within("triangles shifted by 0.03 voxel", seconds[2], seconds[0], 1.3));
  EXPECT_TRUE(test::within("triangles shifted by 0.1 voxel", seconds[3], seconds[0], 1.4));
  EXPECT_TRUE(test::within("triangles shifted by 0.3 voxel", seconds[4], seconds[0], 1.8));
}

} // namespace
} // namespace patina
