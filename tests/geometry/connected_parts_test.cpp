#include "geometry/mesh/holes.h"

#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"
#include "support/changed_mesh.h"

namespace patina {
namespace {

using test::moved;

// Parallel sheets at these heights; each edge is 1 long.
TriangleMesh sheetsAt(const std::vector<double>& heights) {
  TriangleMesh all;
  for (const double z : heights) append(all, moved(sheet(4, 4, 4), Vec3(0, 0, z)));
  return all;
}

TEST(ConnectedParts, AreJoinedUpToSevenTenthsOfTheReach) {
  EXPECT_EQ(connectedParts(sheetsAt({0, 0.69}), 1).parts.size(), 1U);
  EXPECT_EQ(connectedParts(sheetsAt({0, 0.71}), 1).parts.size(), 2U);
  EXPECT_EQ(connectedParts(sheetsAt({0, 0.3, 0.8, 1.1}), 1).parts.size(), 1U);
  EXPECT_EQ(connectedParts(sheetsAt({0, 0.3, 1.1, 1.4}), 1).parts.size(), 2U);
}

TEST(ConnectedParts, DoNotDependOnDistantParts) {
  for (const std::vector<double>& heights :
       {std::vector{0.0, 0.3, 0.8, 1.1}, {0.0, 0.3, 1.1, 1.4}, {0.0, 0.3, 0.98}, {0.0, 0.65}}) {
    const TriangleMesh sheets = sheetsAt(heights);
    TriangleMesh more = sheets;
    append(more, moved(sheet(1, 1, 1), Vec3(100, 0, 0)));
    const ConnectedParts alone = connectedParts(sheets, 1), beside = connectedParts(more, 1);
    EXPECT_EQ(beside.parts.size(), alone.parts.size() + 1);
    for (std::size_t f = 0; f < sheets.triangles.size(); ++f)
      EXPECT_EQ(beside.part_of[f], alone.part_of[f]) << f;
    for (std::size_t i = 0; i < alone.rims.size(); ++i)
      EXPECT_EQ(beside.rims[i].covered, alone.rims[i].covered) << i;
  }
}

} // namespace
} // namespace patina
