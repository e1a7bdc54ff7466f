#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>

#include "geometry/mesh/shapes.h"
#include "visualization/surfaces/surface_data.h"

namespace patina {
namespace {

Vec3 normalAt(vtkPolyData* data, vtkIdType i) {
  return Vec3(data->GetPointData()->GetNormals()->GetTuple3(i));
}

TEST(SurfaceData, SphereKeepsItsVerticesAndHasRadialNormals) {
  const TriangleMesh mesh = icosphere(0.03, 16);
  const auto data = surfaceData(mesh);
  EXPECT_EQ(data->GetNumberOfPoints(), static_cast<vtkIdType>(mesh.positions.size()));
  EXPECT_EQ(data->GetNumberOfPolys(), static_cast<vtkIdType>(mesh.triangles.size()));
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    ASSERT_GT(normalAt(data, i).dot(Vec3(data->GetPoint(i)).normalized()), 0.999);
}

TEST(SurfaceData, BoxIsSplitAtItsEdgesIntoSixFlatSides) {
  const auto data = surfaceData(box(Vec3(1, 2, 3), 4));
  // 5 x 5 vertices on each of six sides, none shared across an edge.
  EXPECT_EQ(data->GetNumberOfPoints(), 6 * 25);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    ASSERT_NEAR(normalAt(data, i).cwiseAbs().maxCoeff(), 1, 1e-6);
}

TEST(SurfaceData, LeavesOutNonFiniteTriangles) {
  TriangleMesh mesh = icosphere(1, 2);
  mesh.positions[0][1] = std::numeric_limits<double>::quiet_NaN();
  std::size_t touched = 0;
  for (const Triangle& triangle : mesh.triangles)
    if (std::set<int>(triangle.begin(), triangle.end()).count(0)) ++touched;
  ASSERT_GT(touched, 0U);
  const auto data = surfaceData(mesh);
  EXPECT_EQ(data->GetNumberOfPolys(), static_cast<vtkIdType>(mesh.triangles.size() - touched));
  for (const double bound : {data->GetBounds()[2], data->GetBounds()[3]})
    EXPECT_TRUE(std::isfinite(bound));
}

TEST(SurfaceData, EmptyMeshGivesAnEmptyPicture) {
  EXPECT_EQ(surfaceData(TriangleMesh{})->GetNumberOfPolys(), 0);
}

} // namespace
} // namespace patina
