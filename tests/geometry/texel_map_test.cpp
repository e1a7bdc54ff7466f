// Texels and their owners against brute force (K16).
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "geometry/atlas/texel_map.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

using Corners = std::array<Vec2, 3>;

Vec2 centre(int i, int j, int width, int height) {
  return {(i + 0.5) / width, (j + 0.5) / height};
}

double cross2(const Vec2& a, const Vec2& b) {
  return a[0] * b[1] - a[1] * b[0];
}

// True if strictly inside, with a margin for rounding.
bool insideBy(const Corners& uv, const Vec2& p, double margin) {
  double sign = cross2(uv[1] - uv[0], uv[2] - uv[0]) < 0 ? -1 : 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 along = uv[(k + 1) % 3] - uv[k];
    if (sign * cross2(along, p - uv[k]) < margin * along.norm()) return false;
  }
  return true;
}

double distanceTo(const Corners& uv, const Vec2& p) {
  if (insideBy(uv, p, 0)) return 0;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 along = uv[(k + 1) % 3] - uv[k];
    const double t = along.squaredNorm() > 0
                         ? std::clamp((p - uv[k]).dot(along) / along.squaredNorm(), 0., 1.)
                         : 0;
    best = std::min(best, (p - uv[k] - t * along).norm());
  }
  return best;
}

// A grid of n x n quads over [low, high]^2 whose inner points are moved at random; below a shift of
// 1/4 no face flips.
CornerUvs shakenGrid(int n, double low, double high, unsigned seed, double shake) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-shake, shake);
  std::vector<Vec2> points;
  const double step = (high - low) / n;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      Vec2 p(low + i * step, low + j * step);
      if (i > 0 && i < n) p[0] += move(random) * step;
      if (j > 0 && j < n) p[1] += move(random) * step;
      points.push_back(p);
    }
  CornerUvs uvs;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto at = [&](int di, int dj) {
        return points[static_cast<std::size_t>((j + dj) * (n + 1) + i + di)];
      };
      if (random() % 2 == 0) {
        uvs.push_back({at(0, 0), at(1, 0), at(1, 1)});
        uvs.push_back({at(0, 0), at(1, 1), at(0, 1)});
      } else {
        uvs.push_back({at(1, 0), at(1, 1), at(0, 1)});
        uvs.push_back({at(1, 0), at(0, 1), at(0, 0)});
      }
    }
  return uvs;
}

// Number of faces that cover each centre: each on its own map, over a face that covers the whole
// image and takes the rest, gutters too.
std::vector<int> coverage(const CornerUvs& uvs, int size) {
  std::vector<int> count(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0);
  for (const Corners& uv : uvs) {
    const TexelMap map = texelMap({uv, {Vec2(0, 0), Vec2(4, 0), Vec2(0, 4)}}, size, size);
    for (std::size_t k = 0; k < count.size(); ++k) count[k] += map.owner[k] == 0;
  }
  return count;
}

// T-K16b: the unit square cut into triangles covers every centre exactly once.
TEST(TexelMap, CoversEveryCentreOfACutSquareOnce) {
  for (unsigned seed = 0; seed < 12; ++seed)
    for (const int size : {16, 24}) {
      const CornerUvs uvs = shakenGrid(6, 0, 1, seed, seed % 3 == 0 ? 0 : 0.24);
      for (const int count : coverage(uvs, size)) ASSERT_EQ(count, 1) << "seed " << seed;
    }
}

// T-K16b in the worst case: edges and corners pass through centres, needles among them.
TEST(TexelMap, SharesNoCentreOnAnEdgeOrCorner) {
  const int size = 16;
  std::mt19937 random(3);
  for (int round = 0; round < 60; ++round) {
    // A fan around a texel's centre; its boundary passes through other centres.
    const Vec2 hub = centre(7, 8, size, size);
    std::vector<Vec2> rim = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int k = 0; k < 12; ++k) {
      const double t = static_cast<double>(random() % 64) / 64;
      rim.push_back(k % 4 == 0   ? Vec2(t, 0)
                    : k % 4 == 1 ? Vec2(1, t)
                    : k % 4 == 2 ? Vec2(t, 1)
                                 : Vec2(0, t));
    }
    std::sort(rim.begin(), rim.end(), [&](const Vec2& a, const Vec2& b) {
      return std::atan2(a[1] - hub[1], a[0] - hub[0]) < std::atan2(b[1] - hub[1], b[0] - hub[0]);
    });
    CornerUvs uvs;
    for (std::size_t k = 0; k < rim.size(); ++k) {
      Corners uv = {hub, rim[k], rim[(k + 1) % rim.size()]};
      if (round % 2) std::swap(uv[1], uv[2]); // flipped faces count like others
      uvs.push_back(uv);
    }
    for (const int count : coverage(uvs, size)) ASSERT_EQ(count, 1) << "round " << round;
  }
}

TEST(TexelMap, OwnersAgreeWithBruteForce) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(0, 1), near(-0.1, 0.1);
  for (int round = 0; round < 40; ++round) {
    const int width = 40, height = round % 2 ? 40 : 28;
    CornerUvs uvs;
    for (int k = 0; k < 12; ++k) {
      const Vec2 a(anywhere(random), anywhere(random));
      const double size = k % 3 == 0 ? 0.02 : 1; // some cover no centre
      const auto other = [&] {
        return Vec2((a + size * Vec2(near(random), near(random))).cwiseMax(0).cwiseMin(1));
      };
      uvs.push_back({a, other(), other()});
    }
    const TexelMap map = texelMap(uvs, width, height);
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) {
        const Vec2 p(i + 0.5, j + 0.5);
        std::int32_t cover = -1, nearest = -1;
        double distance = std::numeric_limits<double>::infinity();
        bool doubtful = false; // on an edge, or at equal distances
        for (std::size_t f = 0; f < uvs.size(); ++f) {
          Corners uv = uvs[f];
          for (Vec2& c : uv) c = {c[0] * width, c[1] * height};
          if (cover < 0 && insideBy(uv, p, 1e-7)) cover = static_cast<std::int32_t>(f);
          const double d = distanceTo(uv, p);
          doubtful = doubtful || (d < 1e-7 && !insideBy(uv, p, 1e-7)) ||
                     std::abs(d - kGutter) < 1e-6 || std::abs(d - distance) < 1e-5;
          if (d < distance) {
            distance = d;
            nearest = static_cast<std::int32_t>(f);
          }
        }
        if (cover >= 0 && distance == 0) {
          ASSERT_LE(map.ownerAt(i, j), cover);
          ASSERT_GE(map.ownerAt(i, j), 0);
          if (!doubtful) {
            ASSERT_EQ(map.ownerAt(i, j), cover);
          }
        } else if (!doubtful) {
          ASSERT_EQ(map.ownerAt(i, j), distance <= kGutter ? nearest : -1) << i << ' ' << j;
        }
      }
  }
}

TEST(TexelMap, LowestFaceOwnsWhereMirroredCoordinatesOverlap) {
  const Corners uv = {Vec2(0.1, 0.1), Vec2(0.9, 0.1), Vec2(0.1, 0.9)};
  const Corners mirrored = {uv[0], uv[2], uv[1]};
  for (const CornerUvs& uvs : {CornerUvs{uv, mirrored}, CornerUvs{mirrored, uv}}) {
    const TexelMap map = texelMap(uvs, 64, 64);
    for (const std::int32_t owner : map.owner) ASSERT_LE(owner, 0);
    EXPECT_EQ(map.ownerAt(20, 20), 0);
  }
}

TEST(TexelMap, FaceSmallerThanATexelHasOneTexel) {
  const Vec2 at(10.1 / 32, 5.9 / 32);
  const CornerUvs uvs = {{at, at + Vec2(1e-4, 0), at + Vec2(0, 1e-4)}};
  EXPECT_EQ(texelMap(uvs, 32, 32).ownerAt(10, 5), 0);
}

TEST(TexelMap, FacesWithoutAreaYieldToOthers) {
  const CornerUvs uvs = {{Vec2(0.5, 0.5), Vec2(0.5, 0.5), Vec2(0.5, 0.5)},
                         {Vec2(0.5, 0.5), Vec2(0.8, 0.5), Vec2(0.5, 0.8)},
                         {Vec2(0.1, 0.1), Vec2(0.1, 0.1), Vec2(0.1, 0.1)}};
  const TexelMap map = texelMap(uvs, 32, 32);
  for (const std::int32_t owner : map.owner) ASSERT_NE(owner, 0);
  EXPECT_EQ(map.ownerAt(16, 16), 1);
  EXPECT_EQ(map.ownerAt(3, 3), 2); // shown by no other face
}

TEST(TexelMap, SkipsNonFiniteCoordinates) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const Corners good = {Vec2(0.2, 0.2), Vec2(0.8, 0.2), Vec2(0.2, 0.8)};
  const CornerUvs uvs = {{Vec2(nan, 0), Vec2(1, 0), Vec2(0, 1)},
                         {Vec2(infinite, 0), Vec2(1, 0), Vec2(0, 1)},
                         {Vec2(1e300, 0), Vec2(1, 0), Vec2(0, -1e300)},
                         good};
  EXPECT_EQ(texelMap(uvs, 33, 17).ownerAt(10, 5), 3);
  EXPECT_EQ(texelMap({}, 8, 8).owner, std::vector<std::int32_t>(64, -1));
  EXPECT_THROW(texelMap(uvs, 0, 8), std::invalid_argument);
  EXPECT_THROW(texelMap(uvs, 8, 20000), std::invalid_argument);
}

TEST(TexelMap, IsTheSameWithOneThread) {
  const CornerUvs uvs = *generateAtlas(icosphere(1, 12), 300).uvs;
  const TexelMap many = texelMap(uvs, 300, 300);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(texelMap(uvs, 300, 300).owner, many.owner);
}

// T-K16a: texel -> point of the surface -> texel.
TEST(TexelBarycentric, ReturnsToTheTexel) {
  const CornerUvs uvs = shakenGrid(9, 0.05, 0.95, 5, 0.24);
  const int size = 128;
  const TexelMap map = texelMap(uvs, size, size);
  int inside = 0;
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) {
      const std::int32_t face = map.ownerAt(i, j);
      if (face < 0) continue;
      const Corners& uv = uvs[static_cast<std::size_t>(face)];
      const Vec2 p = centre(i, j, size, size);
      const Vec3 weights = texelBarycentric(uv, p[0], p[1]);
      ASSERT_GE(weights.minCoeff(), 0);
      ASSERT_NEAR(weights.sum(), 1, 1e-12);
      const Vec2 back = weights[0] * uv[0] + weights[1] * uv[1] + weights[2] * uv[2];
      if (p.minCoeff() > 0.05 && p.maxCoeff() < 0.95) {
        ++inside;
        ASSERT_NEAR((back - p).norm(), 0, 1e-10);
      } else { // gutter: the nearest point of the face
        ASSERT_NEAR((back - p).norm(), distanceTo(uv, p), 1e-10);
      }
    }
  EXPECT_GT(inside, 10000);
}

TEST(TexelBarycentric, IsTheCentroidWithoutArea) {
  const Vec3 third = Vec3::Constant(1.0 / 3);
  EXPECT_EQ(texelBarycentric({Vec2(0, 0), Vec2(0.3, 0.3), Vec2(0.6, 0.6)}, 0.2, 0.4), third);
  EXPECT_EQ(texelBarycentric({Vec2(1, 1), Vec2(1, 1), Vec2(1, 1)}, 0.2, 0.4), third);
}

struct Placed {
  std::array<Vec3, 3> corners;
  Corners uv;
};

Placed randomPlaced(std::mt19937& random, double stretch) {
  std::uniform_real_distribution<double> unit(0, 1);
  Placed face;
  for (Vec3& corner : face.corners) corner = Vec3(unit(random), unit(random), unit(random));
  for (Vec2& uv : face.uv) uv = {0.5 + (unit(random) - 0.5) / stretch, unit(random)};
  return face;
}

// No texel is missed under any stretch, and the box is smaller than the whole face.
TEST(TexelsNear, HoldsEveryTexelThatShowsTheSphere) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  const int width = 96, height = 64;
  double boxes = 0, whole = 0;
  for (int round = 0; round < 300; ++round) {
    const Placed face = randomPlaced(random, round % 3 == 0 ? 10 : 1);
    const TexelMap map = texelMap({face.uv}, width, height);
    const double radius = 0.02 + 0.2 * unit(random);
    const Vec3 about(unit(random), unit(random), unit(random));
    const TexelBox box = texelsNear(face.corners, face.uv, about, radius, width, height);
    const TexelBox all = texelsNear(face.corners, face.uv, about, 10, width, height);
    boxes += std::max(0, box.i1 - box.i0) * std::max(0, box.j1 - box.j0);
    whole += (all.i1 - all.i0) * (all.j1 - all.j0);
    ASSERT_GE(box.i0, 0);
    ASSERT_LE(box.j1, height);
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) {
        if (map.ownerAt(i, j) != 0) continue;
        const Vec2 p = centre(i, j, width, height);
        const Vec3 weights = texelBarycentric(face.uv, p[0], p[1]);
        const Vec3 shown = weights[0] * face.corners[0] + weights[1] * face.corners[1] +
                           weights[2] * face.corners[2];
        if ((shown - about).norm() > radius) continue;
        ASSERT_TRUE(i >= box.i0 && i < box.i1 && j >= box.j0 && j < box.j1) << round;
      }
  }
  EXPECT_LT(boxes, whole / 3);
}

TEST(TexelsNear, IsEmptyFarAwayAndTheWholeFaceWithoutArea) {
  const Corners uv = {Vec2(0.25, 0.25), Vec2(0.75, 0.25), Vec2(0.25, 0.75)};
  const std::array<Vec3, 3> corners = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const TexelBox far = texelsNear(corners, uv, Vec3(0, 0, 2), 1, 64, 64);
  EXPECT_EQ(far.i0, far.i1);
  const TexelBox aside = texelsNear(corners, uv, Vec3(5, 0, 0), 1, 64, 64);
  EXPECT_TRUE(aside.i0 >= aside.i1 || aside.j0 >= aside.j1);
  const std::array<Vec3, 3> line = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
  const TexelBox box = texelsNear(line, uv, Vec3(0, 0, 0), 0.1, 64, 64);
  EXPECT_LE(box.i0, 14);
  EXPECT_GE(box.i1, 50);
}

// T-K16c: a spot painted by a sphere is round under any stretch of the coordinates.
TEST(TexelMap, PaintedSpotIsRoundUnderTenfoldStretch) {
  // A sheet of 1 x 1 m, 10 times finer along u than along v.
  const int width = 1000, height = 100;
  const TriangleMesh mesh = sheet(1, 1, 8);
  CornerUvs uvs;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    Corners uv;
    for (int k = 0; k < 3; ++k)
      uv[static_cast<std::size_t>(k)] = mesh.corner(f, k).head<2>() + Vec2(0.5, 0.5);
    uvs.push_back(uv);
  }
  const TexelMap map = texelMap(uvs, width, height);
  const Vec3 about(0.03, -0.07, 0);
  const double radius = 0.2;
  std::vector<bool> seen(map.owner.size(), false);
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  double area = 0;
  for (std::size_t f = 0; f < uvs.size(); ++f) {
    const std::array<Vec3, 3> corners = {mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2)};
    const TexelBox box = texelsNear(corners, uvs[f], about, radius, width, height);
    for (int j = box.j0; j < box.j1; ++j)
      for (int i = box.i0; i < box.i1; ++i) {
        if (map.ownerAt(i, j) != static_cast<std::int32_t>(f)) continue;
        const Vec2 p = centre(i, j, width, height);
        const Vec3 point =
            position(mesh, {static_cast<std::int32_t>(f), texelBarycentric(uvs[f], p[0], p[1])});
        if ((point - about).norm() > radius) continue;
        const auto texel = static_cast<std::size_t>(j * width + i);
        ASSERT_FALSE(seen[texel]);
        seen[texel] = true;
        const Vec2 d = (point - about).head<2>();
        moment += d * d.transpose();
        area += 1.0 / (width * height);
      }
  }
  const Vec2 axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(moment).eigenvalues().cwiseSqrt();
  const double footprint = (1.0 / height) / radius;
  EXPECT_NEAR(axes[1] / axes[0], 1, 2 * footprint);
  EXPECT_NEAR(area, M_PI * radius * radius, 0.01 * area);
}

} // namespace
} // namespace patina
