// The packet kernel is compiled twice: both must give the same distances.
#include "geometry/tree/triangle_packet.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"
#include "geometry/tree/triangle_pieces.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {

namespace packet_plain { // the kernel for any processor
void lattice(const LatticeJob& job);
void pointCandidates(PointJob& job);
} // namespace packet_plain

namespace {

struct Answer {
  std::vector<std::int32_t> triangle;
  std::vector<float> distance;
};

struct Kernels {
  explicit Kernels(const TriangleMesh& mesh) {
    TrianglePieces pieces = piecesOf(mesh.positions, mesh.triangles);
    nodes = buildWideBvh(pieces.boxes);
    inner = partitionLeavesLast(nodes);
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
    blocks = triangleBlocks(nodes, inner, triangles);
  }

  template <typename Kernel>
  Answer answer(Kernel kernel, double origin, double spacing, int side, double reach) const {
    Answer result;
    result.triangle.resize(static_cast<std::size_t>(side * side * side));
    result.distance.resize(result.triangle.size());
    kernel({nodes.data(),
            inner,
            blocks.data(),
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

  PointJob pointJob(const TriangleMesh& mesh, const Vec3& p) const {
    PointJob job;
    job.nodes = nodes.data();
    job.first_leaf_node = inner;
    job.blocks = blocks.data();
    job.triangles = triangles.data();
    job.corners = mesh.triangles.data()->data();
    job.positions = mesh.positions.data()->data();
    for (int i = 0; i < 3; ++i) job.point[i] = static_cast<float>(p[i]);
    job.reach = 1e6f;
    job.slack = static_cast<float>(2e-6 * (1 + p.cwiseAbs().maxCoeff()));
    return job;
  }

  std::vector<WideNode> nodes;
  std::int32_t inner = 0;
  std::vector<PacketTriangle> triangles;
  std::vector<TriangleBlock> blocks;
};

void expectAgreement(const TriangleMesh& mesh) {
  const Kernels kernels(mesh);
  for (const int side : {4, 8})
    for (const double spacing : {0.02, 0.2})
      for (const double reach : {0.1, 1e3}) {
        const Answer native = kernels.answer(closestOnLattice, -0.71, spacing, side, reach);
        const Answer plain = kernels.answer(packet_plain::lattice, -0.71, spacing, side, reach);
        int found = 0;
        for (std::size_t i = 0; i < native.triangle.size(); ++i) {
          const float a = native.distance[i], b = plain.distance[i];
          if (std::isinf(a) || std::isinf(b)) { // both answers are right at the limit
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

double exactDistance(const TriangleMesh& mesh, std::size_t face, const Vec3& p) {
  const Vec3 a = mesh.corner(face, 0), b = mesh.corner(face, 1), c = mesh.corner(face, 2);
  const Vec3 w = closestBarycentric(p, a, b, c);
  return (w[0] * a + w[1] * b + w[2] * c - p).norm();
}

// The answer is the lowest of the faces that tie in double precision. It is bitwise the same for
// all instruction sets if each kernel returns every one of them.
void expectEveryNearestFace(const TriangleMesh& mesh, double half) {
  const Kernels kernels(mesh);
  std::mt19937 random(17);
  std::uniform_real_distribution<double> u(-half, half);
  for (int i = 0; i < 200; ++i) {
    Vec3 p(u(random), u(random), u(random));
    if (i % 4 == 0) p = mesh.positions[random() % mesh.positions.size()]; // ties
    std::vector<double> distance(mesh.triangles.size());
    for (std::size_t f = 0; f < distance.size(); ++f) distance[f] = exactDistance(mesh, f, p);
    const double least = *std::min_element(distance.begin(), distance.end());
    for (const auto kernel : {trianglesNear, packet_plain::pointCandidates}) {
      PointJob job = kernels.pointJob(mesh, p);
      kernel(job);
      ASSERT_GT(job.count, 0);
      for (std::size_t f = 0; f < distance.size(); ++f) {
        if (distance[f] > least * (1 + 1e-11) + 1e-12) continue;
        const auto found = std::count(job.face, job.face + job.count, static_cast<std::int32_t>(f));
        ASSERT_GT(found, 0) << p.transpose() << " face " << f;
      }
    }
  }
}

// Triangles become thinner and thinner, in all directions.
TriangleMesh needles() {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> u(-0.7, 0.7);
  TriangleMesh mesh;
  for (int i = 0; i < 300; ++i) {
    const Vec3 a(u(random), u(random), u(random)), b(u(random), u(random), u(random));
    const Vec3 side = std::pow(10.0, -i % 16) * (b - a).unitOrthogonal();
    for (const Vec3& p : {a, b, Vec3(a + 0.3 * (b - a) + side)}) mesh.positions.push_back(p);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TEST(TrianglePacket, ReturnsEveryNearestFace) {
  expectEveryNearestFace(icosphere(0.9, 8), 1);
  expectEveryNearestFace(torus(0.7, 0.2, 37, 19), 1);
  expectEveryNearestFace(box(Vec3(1.4, 1, 1e-3)), 1);
  expectEveryNearestFace(needles(), 1);
  expectEveryNearestFace(icosphere(0.9, 3), 300); // far for float
}

TEST(TrianglePacket, NodesAreFullAndNoPathIsTooLong) {
  const TriangleMesh mesh = icosphere(0.9, 30);
  TrianglePieces pieces = piecesOf(mesh.positions, mesh.triangles);
  std::vector<WideNode> nodes = buildWideBvh(pieces.boxes);
  const std::int32_t inner = partitionLeavesLast(nodes);
  EXPECT_LT(nodes.size(), pieces.boxes.size() / 5);
  EXPECT_LT(inner, static_cast<std::int32_t>(nodes.size() / 5));
  std::vector<int> depth(nodes.size(), 0), seen(pieces.boxes.size(), 0);
  depth[0] = 1;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    for (std::size_t k = 0; k < kWide; ++k) {
      if (nodes[n].half[0][k] < 0) continue;
      const std::int32_t child = nodes[n].child[k];
      if (child < 0) {
        ++seen[static_cast<std::size_t>(~child)];
      } else {
        ASSERT_LT(n, static_cast<std::size_t>(inner)); // behind are triangles only
        ASSERT_GT(child, static_cast<std::int32_t>(n));
        depth[static_cast<std::size_t>(child)] = depth[n] + 1;
        ASSERT_LE(depth[n] + 1, 12);
      }
    }
  for (const int count : seen) EXPECT_EQ(count, 1);
}

// Sizes and positions that shrink by powers defeat binned splits, which then split off one box.
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
