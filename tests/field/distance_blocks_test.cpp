// Coarse nodes with several equally near closest points.
#include "field/construction/distance_blocks.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/mesh/shapes.h"
#include "support/sanitized.h"

namespace patina {
namespace {

// A box half as deep along `axis`, its centre `off` voxels from a block's corner. Distances have no
// signs yet.
CoarseNode middleNode(const TriangleMesh& box, int axis, double off) {
  FieldGrid grid;
  grid.voxel = 1;
  grid.origin = Vec3::Constant(-16) + off * Vec3::Unit(axis);
  grid.nodes = {33, 33, 33};
  Progress progress;
  const FieldBuilder builder = distanceBlocks(box, TriangleTree(box), grid, 1, progress, 0, 1);
  const auto n = static_cast<std::size_t>(builder.field.blocks[0]) + 1;
  return builder.field.coarse[(2 * n + 2) * n + 2];
}

Vec3 flat(int axis) {
  return Vec3::Constant(24) - 12 * Vec3::Unit(axis);
}

// The order of the faces and a tiny difference in distance must not matter.
TEST(CoarseNodes, HaveNoDirectionMidwayBetweenTwoFaces) {
  const auto expectNone = [](const TriangleMesh& box, int axis, double off) {
    const CoarseNode node = middleNode(box, axis, off);
    EXPECT_NEAR(node.phi, 6 - std::abs(off), 1e-5);
    EXPECT_LT(Vec3(node.gx, node.gy, node.gz).norm(), 1e-5) << axis << ' ' << off;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const double off : {-0.02, 0.02}) expectNone(box(flat(axis)), axis, off);
  TriangleMesh turned = box(flat(2));
  for (std::size_t first = 0; first < turned.triangles.size(); ++first) {
    std::rotate(turned.triangles.begin(), turned.triangles.begin() + 1, turned.triangles.end());
    expectNone(turned, 2, 0.02);
  }
}

TEST(CoarseNodes, PointAwayFromTheNearerOfTwoFaces) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double off : {-0.3, 0.3}) {
      const CoarseNode node = middleNode(box(flat(axis)), axis, off);
      const Vec3 away = (off > 0 ? -1 : 1) * Vec3::Unit(axis);
      EXPECT_LT((Vec3(node.gx, node.gy, node.gz) - away).norm(), 1e-5) << axis << ' ' << off;
    }
}

// Limits this process to `bytes` more memory during its lifetime.
class Allowance {
 public:
  explicit Allowance(std::size_t bytes) {
    ::getrlimit(RLIMIT_AS, &usual_);
    rlimit less = usual_;
    less.rlim_cur = 1UL << 40; // with any limit the remainder is known
    ::setrlimit(RLIMIT_AS, &less);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    less.rlim_cur = pages * static_cast<std::size_t>(::getpagesize()) + bytes;
    ::setrlimit(RLIMIT_AS, &less);
  }
  ~Allowance() { ::setrlimit(RLIMIT_AS, &usual_); }
  Allowance(const Allowance&) = delete;
  Allowance& operator=(const Allowance&) = delete;

 private:
  rlimit usual_{};
};

// 6,000 of 35,937 blocks are stored: 21 MB beside 5.
TEST(DistanceBlocks, AreRejectedBeforeAllocationIfMemoryIsTooSmall) {
  if (test::kSanitized) GTEST_SKIP() << "a sanitizer takes addresses of its own";
  const TriangleMesh mesh = icosphere(120, 4);
  const TriangleTree tree(mesh);
  FieldGrid grid;
  grid.voxel = 1;
  grid.origin = Vec3::Constant(-128);
  grid.nodes = {257, 258, 259};
  Progress progress;
  const auto blocks = [&] {
    return distanceBlocks(mesh, tree, grid, 3, progress, 0, 1).distance.size();
  };
  const std::size_t stored = blocks(); // also makes the threads allocate their memory
  ASSERT_GT(stored, 4500U);
  std::string cause = "nothing";
  {
    const Allowance allowance(std::size_t{14} << 20);
    try {
      (void)blocks();
    } catch (const Error& error) {
      cause = error.what();
    }
  }
  EXPECT_TRUE(cause.starts_with("a field of 256 x 257 x 258 cells needs about 2")) << cause;
  EXPECT_TRUE(cause.ends_with("; choose a larger voxel or a lower resolution")) << cause;
  EXPECT_EQ(blocks(), stored);
}

} // namespace
} // namespace patina
