#include "field/signs/sign_components.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"
#include "support/soup.h"

namespace patina::signs {
namespace {

TriangleMesh doubled(TriangleMesh mesh) {
  const std::vector<Triangle> once = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
  return mesh;
}

TEST(IsClosed, IsTrueIfNoEdgeHasASingleFace) {
  for (const TriangleMesh& mesh :
       {icosphere(0.05, 3), box(Vec3(1, 2, 3), 2), torus(0.04, 0.015, 9, 7)}) {
    for (const TriangleMesh& given : {mesh, soup(mesh), doubled(mesh), doubled(soup(mesh))}) {
      EXPECT_TRUE(isClosed(given, {}));
      // The result is the same for any removed face and for duplicates.
      for (std::size_t f = 0; f < mesh.triangles.size(); f += 5) {
        TriangleMesh holed = given;
        for (std::size_t i = given.triangles.size() + f; i >= mesh.triangles.size();) {
          i -= mesh.triangles.size();
          holed.triangles.erase(holed.triangles.begin() + static_cast<std::ptrdiff_t>(i));
        }
        EXPECT_FALSE(isClosed(holed, {})) << f;
      }
    }
  }
}

TEST(IsClosed, IgnoresAFaceWithTwoCoincidentCorners) {
  TriangleMesh mesh = box(Vec3(1, 1, 1));
  for (const Triangle& t : {Triangle{0, 0, 1}, Triangle{0, 1, 1}, Triangle{1, 0, 1}}) {
    mesh.triangles.push_back(t);
    EXPECT_TRUE(isClosed(mesh, {}));
  }
}

TEST(IsClosed, IgnoresOpenParts) {
  TriangleMesh mesh = box(Vec3(1, 1, 1));
  OpenParts open;
  open.open.assign(mesh.triangles.size(), 0);
  const auto first = static_cast<std::int32_t>(mesh.positions.size());
  for (const Vec3& p : {Vec3(5, 0, 0), Vec3(6, 0, 0), Vec3(5, 1, 0)}) mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  EXPECT_FALSE(isClosed(mesh, {}));
  open.open.push_back(1);
  open.parts = open.triangles = 1;
  EXPECT_TRUE(isClosed(mesh, open));
  open.open[0] = 1; // the box becomes open
  EXPECT_FALSE(isClosed(mesh, open));
}

// Share of walks from each part that end inside, minus those that end outside.
Eigen::VectorXd walks(const Components& components, const std::vector<float>& inside_confidence) {
  const auto n = static_cast<Eigen::Index>(inside_confidence.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd ends = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto part = static_cast<std::size_t>(i);
    if (std::isnan(inside_confidence[part])) {
      matrix(i, i) = 1;
      continue;
    }
    const Part& p = components.parts[part];
    const double own =
        0.1 * (p.slot < 0 ? 512 : p.nodes) * std::abs(double{inside_confidence[part]});
    matrix(i, i) += own;
    ends[i] = inside_confidence[part] < 0 ? -own : own;
  }
  for (const Link& link : components.links) {
    const auto a = static_cast<Eigen::Index>(link.a), b = static_cast<Eigen::Index>(link.b);
    if (std::isnan(inside_confidence[link.a])) continue;
    matrix(a, a) += link.edges;
    matrix(b, b) += link.edges;
    matrix(a, b) -= link.edges;
    matrix(b, a) -= link.edges;
  }
  return matrix.fullPivLu().solve(ends);
}

TEST(CutLeaks, MatchesTheClosedFormOfTheRandomWalk) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto draw = [&](std::uint32_t below) {
    return static_cast<std::uint32_t>(random() % below);
  };
  int decided = 0;
  for (int round = 0; round < 500; ++round) {
    Components components;
    std::vector<float> inside_confidence;
    const std::uint32_t parts = 3 + draw(8), others = draw(3);
    for (std::uint32_t i = 0; i < parts + others; ++i) {
      Part part;
      part.slot = random() % 4 ? static_cast<std::int32_t>(i) : -1;
      part.nodes = part.slot < 0 ? 0 : static_cast<std::uint16_t>(1 + random() % 512);
      components.parts.push_back(part);
      const bool silent = i != 0 && random() % 3 == 0; // at least one has an inside_confidence
      inside_confidence.push_back(i >= parts ? std::numeric_limits<float>::quiet_NaN()
                                  : silent   ? 0
                                             : unit(random));
    }
    for (std::uint32_t i = 1; i < parts; ++i)
      components.links.push_back({draw(i), i, 1 + draw(20)});
    for (std::uint32_t i = parts + 1; i < parts + others; ++i)
      components.links.push_back({parts, i, 5});
    const std::vector<std::int8_t> sign = cutLeaks(components, inside_confidence);
    const Eigen::VectorXd share = walks(components, inside_confidence);
    for (std::uint32_t i = 0; i < parts + others; ++i) {
      if (i >= parts) {
        ASSERT_EQ(sign[i], 0);
        continue;
      }
      if (std::abs(share[i]) < 0.05) continue;
      ASSERT_EQ(sign[i], share[i] > 0 ? -1 : 1) << round << ' ' << i;
      ++decided;
    }
  }
  EXPECT_GT(decided, 2000);
}

TEST(CutLeaks, PartsWithoutVotesAreOutside) {
  Components components;
  components.parts.resize(2);
  components.parts[0].slot = components.parts[1].slot = 0;
  EXPECT_EQ(cutLeaks(components, {0, 0}), (std::vector<std::int8_t>{1, 1}));
}

} // namespace
} // namespace patina::signs
