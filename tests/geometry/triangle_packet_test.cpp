// The packet kernel is compiled twice: both must give the same distances.
#include "geometry/triangle_packet.h"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "geometry/triangle_pieces.h"
#include "geometry/wide_bvh.h"

namespace patina {
namespace {

struct Answer {
  std::vector<std::int32_t> triangle;
  std::vector<float> distance;
};

struct Kernels {
  explicit Kernels(const TriangleMesh& mesh) {
    TrianglePieces pieces = piecesOf(mesh.positions, mesh.triangles);
    nodes = buildWideBvh(pieces.boxes);
    const auto faces = static_cast<std::int32_t>(mesh.triangles.size());
    for (const BoxRef& box : pieces.boxes) {
      const std::int32_t id = box.id();
      if (id < faces) {
        const auto face = static_cast<std::size_t>(id);
        triangles.push_back(
            packetTriangle(mesh.corner(face, 0), mesh.corner(face, 1), mesh.corner(face, 2), id));
      } else {
        const auto& [a, b, c] = pieces.corners[static_cast<std::size_t>(id - faces)];
        triangles.push_back(
            packetTriangle(a, b, c, pieces.face[static_cast<std::size_t>(id - faces)]));
      }
    }
    fitCylinders(nodes, triangles);
  }

  template <typename Kernel>
  Answer answer(Kernel kernel, double origin, double spacing, int side, double reach) const {
    Answer result;
    result.triangle.resize(static_cast<std::size_t>(side * side * side));
    result.distance.resize(result.triangle.size());
    kernel({nodes.data(),
            triangles.data(),
            0.1f,
            {origin, origin, origin},
            spacing,
            side,
            reach,
            result.triangle.data(),
            result.distance.data()});
    return result;
  }

  std::vector<WideNode> nodes;
  std::vector<PacketTriangle> triangles;
};

void expectAgreement(const TriangleMesh& mesh) {
  const Kernels kernels(mesh);
  for (const int side : {4, 8})
    for (const double spacing : {0.02, 0.2})
      for (const double reach : {0.1, 1e3}) {
        const Answer native = kernels.answer(closestOnLattice, -0.71, spacing, side, reach);
        const Answer plain = kernels.answer(closestOnLatticePlain, -0.71, spacing, side, reach);
        int found = 0;
        for (std::size_t i = 0; i < native.triangle.size(); ++i) {
          const float a = native.distance[i], b = plain.distance[i];
          if (std::isinf(a) || std::isinf(b)) { // at the reach's end either may be
            EXPECT_GT(std::min(a, b), reach * (1 - 1e-6));
            continue;
          }
          ++found;
          EXPECT_NEAR(a, b, 4e-6f * a + 2e-7f);
        }
        EXPECT_TRUE(found > 0 || reach < 1);
      }
}

TEST(TrianglePacket, PlainAndNativeInstructionsAgree) {
  expectAgreement(icosphere(0.9, 8));
  expectAgreement(torus(0.7, 0.2, 60, 30));
  expectAgreement(box(Vec3(1.4, 1, 1e-3)));
  expectAgreement(sheet(1, 1, 3));
}

TEST(TrianglePacket, NodesAreFullAndNoPathIsTooLong) {
  const TriangleMesh mesh = icosphere(0.9, 30);
  TrianglePieces pieces = piecesOf(mesh.positions, mesh.triangles);
  const std::vector<WideNode> nodes = buildWideBvh(pieces.boxes);
  EXPECT_LT(nodes.size(), pieces.boxes.size() / 5);
  std::vector<int> depth(nodes.size(), 0), seen(pieces.boxes.size(), 0);
  depth[0] = 1;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    for (std::size_t k = 0; k < kWide; ++k) {
      if (nodes[n].half[0][k] < 0) continue;
      const std::int32_t child = nodes[n].child[k];
      if (child < 0) {
        ++seen[static_cast<std::size_t>(~child)];
      } else {
        ASSERT_GT(child, static_cast<std::int32_t>(n));
        depth[static_cast<std::size_t>(child)] = depth[n] + 1;
        ASSERT_LE(depth[n] + 1, 12);
      }
    }
  for (const int count : seen) EXPECT_EQ(count, 1);
}

// Sizes and places that shrink by powers defeat binned splits, which then peel off single boxes.
TEST(TrianglePacket, DepthIsBoundedOnAdversarialBoxes) {
  std::vector<BoxRef> boxes(100000);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const float at = std::exp2(-static_cast<float>(i) * 0.0012f);
    for (int a = 0; a < 3; ++a) {
      boxes[i].lo[a] = at;
      boxes[i].hi[a] = at * 1.5f;
    }
    boxes[i].setId(static_cast<std::int32_t>(i));
  }
  const std::vector<WideNode> nodes = buildWideBvh(boxes);
  std::vector<int> depth(nodes.size(), 1);
  int deepest = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    for (std::size_t k = 0; k < kWide; ++k)
      if (nodes[n].half[0][k] >= 0 && nodes[n].child[k] >= 0) {
        depth[static_cast<std::size_t>(nodes[n].child[k])] = depth[n] + 1;
        deepest = std::max(deepest, depth[n] + 1);
      }
  EXPECT_LE(deepest, kMaxTreeDepth);
}

} // namespace
} // namespace patina
