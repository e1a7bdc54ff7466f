// Overlap of texture coordinates, against an independent test of all pairs of faces.
#include "geometry/atlas/uv_overlap.h"

#include <functional>
#include <random>

#include "geometry/atlas_checks.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

using test::Corners, test::separation;

Corners turned(Corners uv) {
  if (test::cross(uv[1] - uv[0], uv[2] - uv[0]) < 0) std::swap(uv[1], uv[2]);
  return uv;
}

// Depth of overlap of two faces; negative if they are separate.
double depth(const Corners& a, const Corners& b) {
  return -separation(turned(a), turned(b));
}

double deepest(const CornerUvs& uvs) {
  double most = -1;
  for (std::size_t a = 0; a < uvs.size(); ++a)
    for (std::size_t b = a + 1; b < uvs.size(); ++b) most = std::max(most, depth(uvs[a], uvs[b]));
  return most;
}

void expectFound(const CornerUvs& uvs) {
  const auto found = findUvOverlap(uvs);
  ASSERT_TRUE(found);
  ASSERT_LT(found->a, found->b);
  EXPECT_GT(depth(uvs[index(found->a)], uvs[index(found->b)]), kUvResolution);
  const auto again = findUvOverlap(uvs);
  EXPECT_EQ(again->a, found->a);
  EXPECT_EQ(again->b, found->b);
}

// A grid of 2 n^2 faces over the unit square whose inner points are moved by up to a third of a
// cell.
CornerUvs grid(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-1. / 3, 1. / 3);
  std::vector<Vec2> points;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const bool inside = i > 0 && j > 0 && i < n && j < n;
      points.push_back(Vec2(i + (inside ? shift(random) : 0), j + (inside ? shift(random) : 0)) /
                       n);
    }
  CornerUvs uvs;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto at = [&](int x, int y) {
        return points[static_cast<std::size_t>((j + y) * (n + 1) + i + x)];
      };
      uvs.push_back({at(0, 0), at(1, 0), at(1, 1)});
      uvs.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  return uvs;
}

// Faces of a regular polygon of n corners around its centre.
CornerUvs fan(int n) {
  const auto at = [&](int k) {
    const double angle = 2 * std::numbers::pi * (k % n) / n;
    return Vec2(0.5 + 0.49 * std::cos(angle), 0.5 + 0.49 * std::sin(angle));
  };
  CornerUvs uvs;
  for (int k = 0; k < n; ++k) uvs.push_back({Vec2(0.5, 0.5), at(k), at(k + 1)});
  return uvs;
}

CornerUvs changed(CornerUvs uvs, const std::function<Vec2(const Vec2&)>& map) {
  for (Corners& uv : uvs)
    for (Vec2& p : uv) p = map(p);
  return uvs;
}

CornerUvs both(CornerUvs a, const CornerUvs& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(UvOverlap, IsAbsentIfFacesOnlyTouch) {
  for (const int n : {1, 2, 7, 40}) EXPECT_FALSE(findUvOverlap(grid(n, 1))) << n;
  for (const int n : {3, 17, 400, 20000}) EXPECT_FALSE(findUvOverlap(fan(n))) << n;
  EXPECT_FALSE(findUvOverlap({}));
  // Two halves side by side whose corners lie on each other's edges.
  const auto left = [](const Vec2& p) { return Vec2(p[0] / 2, p[1]); };
  const auto right = [](const Vec2& p) { return Vec2(0.5 + p[0] / 2, p[1]); };
  EXPECT_FALSE(findUvOverlap(both(changed(grid(7, 2), left), changed(grid(11, 3), right))));
}

TEST(UvOverlap, IsAbsentInGeneratedAtlases) {
  for (const TriangleMesh& mesh :
       {icosphere(1, 20), torus(1, 0.4, 60, 30), box(Vec3(1, 2, 3), 9), vase(), galleon(1),
        sheet(1, 2, 30), test::spiralRamp(20, 0.3, 0.1, 0),
        withShrunkenTriangles(icosphere(1, 4), 0.1)})
    EXPECT_FALSE(findUvOverlap(*generateAtlas(mesh, 1024).uvs));
}

TEST(UvOverlap, IsFoundWhereverFacesOverlap) {
  const CornerUvs plain = grid(12, 4);
  const auto mirrored = [](const Vec2& p) { return Vec2(std::abs(2 * p[0] - 1), p[1]); };
  const auto tiled = [](const Vec2& p) { return Vec2(p[0] < 0.5 ? 2 * p[0] : 2 * p[0] - 1, p[1]); };
  const auto shifted = [](const Vec2& p) { return Vec2(p[0] + 1e-3, p[1]); };
  const auto small = [](const Vec2& p) { return Vec2(0.4 + p[0] / 500, 0.3 + p[1] / 500); };
  const auto turned_over = [](const Vec2& p) { return Vec2(p[1], p[0]); };
  expectFound(changed(grid(12, 0), mirrored));
  expectFound(changed(changed(grid(12, 0), tiled), mirrored));
  expectFound(both(plain, plain));                       // every face twice
  expectFound(both(plain, changed(plain, turned_over))); // with opposite orientation
  expectFound(both(changed(plain, [](const Vec2& p) { return Vec2(p * 0.99); }),
                   changed(changed(plain, [](const Vec2& p) { return Vec2(p * 0.99); }), shifted)));
  expectFound(both(CornerUvs{{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}}, changed(plain, small)));
  expectFound(both(fan(2000), changed(fan(3), small)));
  expectFound(both(fan(2000), changed(fan(2000), turned_over))); // about one hub
  CornerUvs wound = fan(400);                                    // one face of it once more
  wound.push_back({wound[399][0], wound[399][1], Vec2(0.99, 0.52)});
  expectFound(wound);
  expectFound(CornerUvs(5000, Corners{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)})); // all on one face
  expectFound(CornerUvs(5000, Corners{Vec2(.3, .3), Vec2(.301, .3), Vec2(.3, .301)}));
  // Six sides on the whole square.
  CornerUvs sides;
  for (int side = 0; side < 6; ++side) sides = both(sides, grid(1, 5));
  expectFound(sides);
  // Crossed bars, none of whose corners lies in the other.
  expectFound({{Vec2(0.1, 0.5), Vec2(0.9, 0.5), Vec2(0.9, 0.501)},
               {Vec2(0.5, 0.1), Vec2(0.501, 0.1), Vec2(0.5, 0.9)}});
}

TEST(UvOverlap, AgreesWithAllPairsOfRandomFaces) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  int overlapping = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const double size = 0.4 * std::pow(unit(random), 3);
    CornerUvs uvs;
    for (int k = 0; k < 60; ++k) {
      const Vec2 at(0.2 + 0.6 * unit(random), 0.2 + 0.6 * unit(random));
      Corners uv;
      double angle = 7 * unit(random);
      for (Vec2& p : uv) {
        p = at + size / 2 * Vec2(std::cos(angle), std::sin(angle));
        angle += 1.7 + 0.6 * unit(random);
      }
      uvs.push_back(uv);
    }
    const double most = deepest(uvs);
    if (std::abs(most) < 5 * kUvResolution) continue;
    overlapping += most > 0;
    ASSERT_EQ(findUvOverlap(uvs).has_value(), most > 0) << trial;
  }
  EXPECT_GT(overlapping, 100);
  EXPECT_LT(overlapping, 390);
}

TEST(UvOverlap, IgnoresFoldsFromRounding) {
  // Coordinates rounded to five decimals like those of a file: some needles flip.
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  CornerUvs uvs = grid(12, 9);
  const auto needles = [&](const CornerUvs& faces) {
    CornerUvs cut;
    for (const Corners& uv : faces) {
      // A point next to an edge cuts a face into three, one of which is a needle.
      const double t = 0.2 + 0.6 * unit(random), off = 1e-6 * unit(random);
      const Vec2 p = (1 - off) * ((1 - t) * uv[0] + t * uv[1]) + off * uv[2];
      for (std::size_t k = 0; k < 3; ++k) cut.push_back({p, uv[k], uv[(k + 1) % 3]});
    }
    return cut;
  };
  uvs = needles(uvs);
  EXPECT_FALSE(findUvOverlap(uvs));
  for (const double decimals : {1e7, 1e6, 1e5}) {
    const CornerUvs rounded = changed(
        uvs, [&](const Vec2& p) { return Vec2((p * decimals).array().round() / decimals); });
    EXPECT_GT(deepest(rounded), 0);
    EXPECT_FALSE(findUvOverlap(rounded)) << decimals;
  }
  EXPECT_FALSE(
      findUvOverlap(changed(uvs, [](const Vec2& p) { return p.cast<float>().cast<double>(); })));
}

TEST(UvOverlap, IgnoresFacesWithoutArea) {
  const CornerUvs plain = grid(3, 10);
  EXPECT_FALSE(
      findUvOverlap(both(plain, CornerUvs(9, Corners{plain[0][1], plain[0][1], plain[0][1]}))));
  EXPECT_FALSE(findUvOverlap(both(plain, {{Vec2(0, 0), Vec2(1, 1), Vec2(0.5, 0.5)}})));
}

} // namespace
} // namespace patina
