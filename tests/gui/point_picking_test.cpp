// Three pairs of points on a path and its mesh are clicked, and the path moves accordingly.
#include <gtest/gtest.h>

#include "app/gui/aligning/align_central_views.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

TEST(PointPicking, PlacesThePathByThreePairsAndIgnoresDuplicates) {
  const TriangleMesh ball = icosphere(0.04, 12);
  const Pose belongs =
      Eigen::Translation3d(0.2, -0.1, 0.3) * Eigen::AngleAxisd(0.6, Vec3(1, 2, 3).normalized());
  std::vector<PathSample> path(3);
  std::vector<Vec3> places; // centres of faces
  for (const auto& face : {ball.triangles[0], ball.triangles[500], ball.triangles[1000]})
    places.push_back((ball.positions[face[0]] + ball.positions[face[1]] + ball.positions[face[2]]) /
                     3);
  for (std::size_t i = 0; i < 3; ++i) path[i].position = belongs.inverse() * places[i];
  Alignment alignment;
  alignment.setMesh(std::make_shared<const TriangleMesh>(ball));
  alignment.setPath(path);
  PointPicking picking(alignment);
  EXPECT_TRUE(picking.words().isEmpty());
  picking.set(true);
  const auto look = [&](const Vec3& at, double beside = 0) { // from outside
    const Vec3 out = at.normalized();
    picking.pick({at + 0.5 * out + beside * out.unitOrthogonal(), -out}, 1e-6);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_FALSE(picking.pose());
    look(alignment.pose() * path[i].position, 2e-6); // out of reach
    EXPECT_EQ(picking.marks().size(), 2 * i);
    look(alignment.pose() * path[i].position);
    EXPECT_EQ(picking.marks().size(), 2 * i + 1);
    if (i > 0) look(places[i - 1]); // looks at the previous pair
    EXPECT_EQ(picking.marks().size(), 2 * i + 1);
    look(places[i]);
    EXPECT_EQ(picking.marks().size(), 2 * i + 2);
  }
  ASSERT_TRUE(picking.pose());
  EXPECT_LT((picking.pose()->matrix() - belongs.matrix()).norm(), 1e-6);
  picking.set(true);
  EXPECT_TRUE(picking.marks().empty());
}

} // namespace
} // namespace patina
