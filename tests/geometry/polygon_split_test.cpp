// Polygons become triangles: the outline is kept for any shape and first corner.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/polygon_split.h"

namespace patina {
namespace {

using Outline = std::vector<Vec2>;

Outline regular(std::size_t corners) {
  Outline outline;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(corners);
    outline.emplace_back(std::cos(angle), std::sin(angle));
  }
  return outline;
}

Outline star(std::size_t points) {
  Outline outline = regular(2 * points);
  for (std::size_t i = 0; i < outline.size(); i += 2) outline[i] *= 0.3;
  return outline;
}

Outline comb(int teeth) {
  Outline outline = {{0, 0}, {2.0 * teeth - 1, 0}};
  for (int i = teeth - 1; i >= 0; --i) {
    outline.emplace_back(2 * i + 1, 3);
    outline.emplace_back(2 * i, 3);
    if (i == 0) break;
    outline.emplace_back(2 * i, 1);
    outline.emplace_back(2 * i - 1, 1);
  }
  return outline;
}

Outline spiral() {
  return {{0, 0}, {9, 0}, {9, 9}, {1, 9}, {1, 3}, {6, 3}, {6, 6}, {4, 6},
          {4, 5}, {5, 5}, {5, 4}, {2, 4}, {2, 8}, {8, 8}, {8, 1}, {0, 1}};
}

// A square with a square hole, cut open along an edge that occurs twice.
Outline keyhole() {
  return {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}};
}

Outline randomStar(unsigned seed) {
  std::mt19937 random(seed);
  Outline outline = regular(5 + random() % 40);
  for (Vec2& p : outline) p *= 0.1 + static_cast<double>(random() % 1000) / 1000;
  return outline;
}

// Spikes from a point of the outline to a tip and back, as in edited drawings: from the middle of
// an edge to either side, and from a corner along its edge, over it.
Outline spiked(const Outline& outline, std::size_t at, double length) {
  const Vec2 a = outline[at], b = outline[(at + 1) % outline.size()], along = (b - a).normalized();
  const Vec2 middle = (a + b) / 2, tip = middle + length * Vec2(along.y(), -along.x());
  Outline out(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(at + 1));
  if (length > 0)
    out.insert(out.end(), {middle, tip, middle});
  else
    out.push_back(b - length * along);
  out.insert(out.end(), outline.begin() + static_cast<std::ptrdiff_t>(at + 1), outline.end());
  return out;
}

std::vector<Outline> outlines() {
  std::vector<Outline> all = {
      {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},                 // L
      {{0, 0}, {3, 0}, {3, 3}, {2, 1}},                                 // arrow head
      {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 2}, {0, 2}},                 // corners in line
      {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}, // on each side
      {{0, 0}, {1, 0}, {4, 0}, {2, 2}},                                 // a triangle with one more
      {{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 2}, {1, 2}, {1, 4}, {0, 4}}, // notch
      {{0, 0}, {2, 1}, {4, 0}, {3, 2}, {4, 4}, {2, 3}, {0, 4}, {1, 2}}, // four points
      {{0, 0}, {4, 0}, {4, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, // U
      {{0, 2}, {1, 2}, {1, 0}, {2, 0}, {2, 2}, {3, 2}, {3, 3}, {0, 3}}, // T
      {{0, 0}, {5, 0}, {5, 5}, {3, 5}, {3, 2}, {3, 5}, {0, 5}},         // a slit without width
      keyhole(),
      spiral(),
      star(5),
      star(30),
      comb(3),
      comb(40),
      regular(4),
      regular(17)};
  for (unsigned seed = 0; seed < 30; ++seed) all.push_back(randomStar(seed));
  for (const std::size_t corners : {3u, 4u, 5u, 12u})
    for (const double length : {0.25, 3.0, -0.25, -3.0})
      for (std::size_t at = 0; at < corners; ++at)
        all.push_back(spiked(regular(corners), at, length));
  for (const double length : {0.25, -0.25})
    for (std::size_t at = 0; at + 1 < comb(3).size(); ++at)
      all.push_back(spiked(comb(3), at, length));
  return all;
}

double areaOf(const Outline& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

bool contains(const Outline& outline, const Vec2& p) { // parity of crossings
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()))
      inside = !inside;
  }
  return inside;
}

TriangleMesh fanOf(const std::vector<Vec3>& corners) {
  TriangleMesh mesh;
  mesh.positions = corners;
  for (std::int32_t k = 1; index(k) + 1 < corners.size(); ++k) {
    mesh.triangles.push_back({0, k, k + 1});
    mesh.corner_uvs.push_back({Vec2(0, 7), Vec2(k, 7), Vec2(k + 1, 7)});
  }
  return mesh;
}

std::vector<Vec3> inSpace(const Outline& outline, const Eigen::Affine3d& placed) {
  std::vector<Vec3> corners;
  for (const Vec2& p : outline) corners.push_back(placed * Vec3(p.x(), p.y(), 0));
  return corners;
}

TEST(PolygonSplit, KeepsEveryOutlineFromEveryCorner) {
  std::mt19937 random(5);
  for (const Outline& given : outlines())
    for (std::size_t first = 0; first < given.size(); first += 1 + given.size() / 12) {
      Outline outline = given;
      std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(first),
                  outline.end());
      TriangleMesh mesh = fanOf(inSpace(outline, Eigen::Affine3d::Identity()));
      const PolygonFaults faults = splitPolygons(mesh, {{0, outline.size()}});
      EXPECT_EQ(faults.crossing + faults.too_long, 0u);
      double sum = 0;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Outline triangle = {mesh.corner(t, 0).head<2>(), mesh.corner(t, 1).head<2>(),
                                  mesh.corner(t, 2).head<2>()};
        EXPECT_GE(areaOf(triangle), -1e-12);
        sum += areaOf(triangle);
        for (std::size_t k = 0; k < 3; ++k) // each texture point stays with its corner
          EXPECT_EQ(mesh.corner_uvs[t][k], Vec2(mesh.triangles[t][k], 7));
      }
      EXPECT_NEAR(sum, areaOf(outline), 1e-9);
      Box3 box = bounds(mesh);
      for (int i = 0; i < 300; ++i) {
        const auto share = [&] { return static_cast<double>(random()) / 4294967296.0; };
        const Vec2 p(box.min().x() + share() * box.sizes().x(),
                     box.min().y() + share() * box.sizes().y());
        int covers = 0;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
          covers += contains({mesh.corner(t, 0).head<2>(), mesh.corner(t, 1).head<2>(),
                              mesh.corner(t, 2).head<2>()},
                             p);
        ASSERT_EQ(covers, contains(outline, p) ? 1 : 0) << outline.size() << " corners";
      }
    }
}

TEST(PolygonSplit, KeepsTheAreaIfReversedAndFarFromTheOrigin) {
  Eigen::Affine3d placed =
      Eigen::Translation3d(4.5e6, -5.2e6, 300) * Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized());
  for (Outline outline : outlines()) {
    std::reverse(outline.begin(), outline.end());
    TriangleMesh mesh = fanOf(inSpace(outline, placed));
    splitPolygons(mesh, {{0, outline.size()}});
    EXPECT_NEAR(area(mesh), std::abs(areaOf(outline)), 1e-6);
    Vec3 sum = Vec3::Zero();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      sum += (mesh.corner(t, 1) - mesh.corner(t, 0)).cross(mesh.corner(t, 2) - mesh.corner(t, 0));
    EXPECT_GT((placed.linear() * Vec3(0, 0, -1)).dot(sum), 0);
  }
}

TEST(PolygonSplit, KeepsTheFanOfAFlatConvexPolygon) {
  for (const std::size_t corners : {4u, 5u, 17u}) {
    TriangleMesh mesh = fanOf(inSpace(regular(corners), Eigen::Affine3d::Identity()));
    const std::vector<Triangle> before = mesh.triangles;
    splitPolygons(mesh, {{0, corners}});
    EXPECT_EQ(mesh.triangles, before);
  }
}

double worstFold(const TriangleMesh& mesh) { // cosine; over pairs with a common edge
  double worst = 1;
  for (std::size_t s = 0; s < mesh.triangles.size(); ++s)
    for (std::size_t t = s + 1; t < mesh.triangles.size(); ++t) {
      int common = 0;
      for (const std::int32_t v : mesh.triangles[s])
        common +=
            static_cast<int>(std::count(mesh.triangles[t].begin(), mesh.triangles[t].end(), v));
      if (common == 2) worst = std::min(worst, faceNormal(mesh, s).dot(faceNormal(mesh, t)));
    }
  return worst;
}

// The inner edge by its two ends.
std::pair<std::int32_t, std::int32_t> diagonalOf(const TriangleMesh& mesh) {
  std::vector<std::int32_t> ends;
  for (const std::int32_t v : mesh.triangles[0])
    if (std::count(mesh.triangles[1].begin(), mesh.triangles[1].end(), v) > 0) ends.push_back(v);
  return std::minmax(ends.at(0), ends.at(1));
}

TEST(PolygonSplit, FoldsAQuadTheLeastForAnyFirstCorner) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Vec3> corners = inSpace(regular(4), Eigen::Affine3d::Identity());
    for (Vec3& p : corners)
      for (int k = 0; k < 3; ++k) p[k] += static_cast<double>(random() % 1000) / 2500;
    TriangleMesh one = fanOf(corners), other = one;
    other.triangles = {{1, 2, 3}, {1, 3, 0}};
    const double least = std::max(worstFold(one), worstFold(other));
    for (std::int32_t first = 0; first < 4; ++first) {
      TriangleMesh mesh = one;
      for (std::int32_t t = 0; t < 2; ++t)
        mesh.triangles[index(t)] = {first, (first + t + 1) % 4, (first + t + 2) % 4};
      mesh.corner_uvs.clear();
      splitPolygons(mesh, {{0, 4}});
      EXPECT_NEAR(worstFold(mesh), least, 1e-9);
    }
  }
}

TEST(PolygonSplit, SaddleOfEqualFoldsDoesNotDependOnItsFirstCorner) {
  const std::vector<Vec3> corners = {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, 1, 1), Vec3(0, 1, 0)};
  std::vector<std::pair<std::int32_t, std::int32_t>> found;
  for (std::int32_t first = 0; first < 4; ++first) {
    TriangleMesh mesh = fanOf(corners);
    mesh.corner_uvs.clear();
    for (std::int32_t t = 0; t < 2; ++t)
      mesh.triangles[index(t)] = {first, (first + t + 1) % 4, (first + t + 2) % 4};
    splitPolygons(mesh, {{0, 4}});
    found.push_back(diagonalOf(mesh));
  }
  EXPECT_EQ(std::count(found.begin(), found.end(), found[0]), 4);
}

TEST(PolygonSplit, FoldsALargerPolygonAlongItsRidge) {
  // A roof over a hexagon: only the ridge from (0, 0, 1) to (0, 4, 1) may be an edge.
  std::vector<Vec3> corners = {Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0),
                               Vec3(1, 4, 0),  Vec3(0, 4, 1), Vec3(-1, 4, 0)};
  for (int turn = 0; turn < 6; ++turn) {
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    TriangleMesh mesh = fanOf(corners);
    splitPolygons(mesh, {{0, 6}});
    EXPECT_NEAR(area(mesh), 2 * 4 * std::sqrt(2.0), 1e-9);
  }
}

TEST(PolygonSplit, CountsOutlinesThatCrossAndKeepsThemAsTriangles) {
  TriangleMesh bow =
      fanOf({Vec3(0, 0, 0), Vec3(2, 2, 0), Vec3(3, 0, 0), Vec3(0, 1, 0), Vec3(-5, -1, 0)});
  TriangleMesh pentagram = fanOf(inSpace(regular(5), Eigen::Affine3d::Identity()));
  std::swap(pentagram.positions[1], pentagram.positions[2]);
  std::swap(pentagram.positions[2], pentagram.positions[4]);
  for (TriangleMesh* mesh : {&bow, &pentagram}) {
    EXPECT_EQ(splitPolygons(*mesh, {{0, 5}}).crossing, 1u);
    EXPECT_EQ(mesh->triangles.size(), 3u);
  }
}

TEST(PolygonSplit, KeepsOutlinesWithoutAreaOrNotFinite) {
  for (const std::vector<Vec3>& corners :
       {std::vector<Vec3>(5, Vec3(1, 2, 3)),
        std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)},
        std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(NAN, 1, 0), Vec3(0, 1, 0)},
        std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1e308, 1e308, -1e308),
                          Vec3(-1e308, 1, 0)}}) {
    TriangleMesh mesh = fanOf(corners);
    EXPECT_EQ(splitPolygons(mesh, {{0, corners.size()}}).too_long, 0u);
    EXPECT_EQ(mesh.triangles.size(), corners.size() - 2);
  }
}

TEST(PolygonSplit, NotchedCapIsReadWithoutALid) {
  const std::string obj =
      "v 40 20 0\nv 20 20 0\nv 20 40 0\nv 0 40 0\nv 0 0 0\nv 40 0 0\nv 40 20 20\nv 20 20 20\n"
      "v 20 40 20\nv 0 40 20\nv 0 0 20\nv 40 0 20\nf 6 5 4 3 2 1\nf 7 8 9 10 11 12\nf 1 2 8 7\n"
      "f 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";
  const TriangleMesh mesh = parseObj(obj, "t");
  EXPECT_TRUE(inspect(mesh).watertight);
  EXPECT_NEAR(area(mesh), 2 * 1200 + 160 * 20, 1e-9);
  EXPECT_NEAR(volume(mesh), 1200 * 20, 1e-9);
}

} // namespace
} // namespace patina
