// Open surfaces (a terrain, a sheet, scans with holes) pressed from the front away from the
// boundary. There they bound a body, and the exact proxy on that body is the reference.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "app/studies/contact/contact_trials.h"
#include "app/studies/contact/scenes.h"
#include "contact/course_limits.h"
#include "contact/ways.h"
#include "field/construction/build_field.h"
#include "geometry/mesh/shapes.h"
#include "support/changed_mesh.h"
#include "support/mesh_defects.h"
#include "support/node_values.h"

namespace patina::test {
namespace {

constexpr double kSide = 0.1, kBelow = 3e-3; // [m]
constexpr double kFromRim = 6e-3;            // [m], a hole affects the surface only within it
constexpr int kFine = 160;                   // 51,200 triangles
constexpr int kCoarse = 80;                  // the voxel must still resolve the noise

struct OpenSurface {
  std::string name;
  TriangleMesh felt; // open
  TriangleMesh body; // the same, closed
};

// Hills of some 20 degrees, and the noise of a scanner.
TriangleMesh terrainBody(int cells, double noise) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  return reliefBlock(kSide, -0.03, cells, [&](double x, double y) {
    return 4e-3 * std::sin(90 * x + 0.4) * std::cos(80 * y) + noise * normal(random);
  });
}
// The upper face of a reliefBlock.
TriangleMesh topOf(TriangleMesh block, int cells) {
  std::erase_if(block.triangles, [=](const Triangle& t) {
    return *std::max_element(t.begin(), t.end()) >= (cells + 1) * (cells + 1);
  });
  return block;
}

std::vector<OpenSurface> openSurfaces() {
  const TriangleMesh terrain = terrainBody(kFine, 0), scanned = terrainBody(kCoarse, 0.03e-3);
  const TriangleMesh flat =
      tilted(reliefBlock(kSide, -0.03, 4, [](double, double) { return 0.0; }));
  const TriangleMesh rough = roughSolid(5);
  return {{"terrain", topOf(terrain, kFine), terrain},
          {"sheet", topOf(flat, 4), flat},
          {"scan", withHoles(topOf(scanned, kCoarse), 6, 2e-3, 4), scanned},
          {"body with holes", withHoles(rough, 5, 3e-3, 4), rough}};
}

double distanceTo(const std::vector<std::pair<Vec3, Vec3>>& rim, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : rim) {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + t * (b - a) - p).norm());
  }
  return least;
}

// Returns tips that start 3 mm above a random face, go kBelow under the surface, slide 10 mm along
// it and come up; side = -1 begins behind the face. Empty near the boundary.
std::vector<Vec3> touch(const OpenSurface& surface, const ExactSurface& body,
                        const std::vector<std::pair<Vec3, Vec3>>& rim, double iso, double side,
                        std::mt19937& random) {
  std::uniform_int_distribution<std::size_t> any(0, surface.felt.triangles.size() - 1);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::size_t f = any(random);
  const Vec3 place =
      (surface.felt.corner(f, 0) + surface.felt.corner(f, 1) + surface.felt.corner(f, 2)) / 3;
  const Vec3 out = side * faceNormal(surface.felt, f);
  const Vec3 along = Eigen::AngleAxisd(6.28 * unit(random), out) * out.unitOrthogonal();
  const double speed = 0.01 + 0.19 * unit(random), step = speed * kTick;
  std::vector<Vec3> tips;
  for (double h = 3e-3; h > -kBelow; h -= 0.05e-3) tips.push_back(place + (iso + h) * out);
  for (double s = 0; s < 10e-3; s += step) {
    const Vec3 foot = body.nearest(place + s * along).point;
    if (distanceTo(rim, foot) < kFromRim) return {};
    tips.push_back(foot + (iso - kBelow) * out);
  }
  const Vec3 last = tips.back();
  for (double h = 0; h < kBelow + 3e-3; h += 0.05e-3) tips.push_back(last + h * out);
  return tips;
}

TrialReport pressed(const OpenSurface& surface, const ExactSurface& body, double iso,
                    OpenSides sides, double side) {
  ContactScene scene{surface.name, {surface.felt}};
  scene.sides = sides;
  const auto snapshot = contactSnapshot(contactField(scene, iso, 150), iso, "");
  const auto rim = rims(surface.felt);
  ContactChecker checker(methodOf(*snapshot), body, iso);
  TrialReport report;
  std::mt19937 random(11);
  for (int touches = 0; touches < 30;) {
    const std::vector<Vec3> tips = touch(surface, body, rim, iso, side, random);
    if (tips.empty()) continue;
    ++touches;
    checker.restart();
    for (const Vec3& tip : tips) checker.feel(tip, report);
  }
  return report;
}

void expectHeld(const TrialReport& report, const std::string& what) {
  EXPECT_GT(report.contacts, 3000) << what;
  expectFaultless(report, what);
  const Percentiles error = percentiles(report.error);
  std::printf("%-18s %ld ticks in contact, %ld lost, %ld pulls, step %.3f N, error p50 %.4f p99 "
              "%.3f p99.9 %.3f N\n",
              what.c_str(), report.contacts, report.lost, report.pulls, report.worst_excess,
              error.p50, error.p99, error.p999);
}

TEST(OpenSurface, FrontContactMatchesTheSolidThatItBounds) {
  TrialReport all;
  for (const OpenSurface& surface : openSurfaces()) {
    const ExactSurface body({surface.body});
    for (const double iso : {0.0, 1e-3}) {
      const TrialReport report = pressed(surface, body, iso, OpenSides::one, 1);
      expectHeld(report, surface.name + (iso > 0 ? " with a tip" : ""));
      all.add(report);
    }
  }
  expectExact(all, "one-sided");
}

// The triangles are the reference: a sheet without thickness, around which the tip rolls.
TEST(OpenSurface, TwoSidedSurfaceIsTouchedFromBothSides) {
  TrialReport all;
  for (const OpenSurface& surface : openSurfaces()) {
    if (surface.name == "body with holes") continue; // closed: it has one side
    const ExactSurface sheet({surface.felt});
    for (const double side : {1.0, -1.0}) {
      const TrialReport report = pressed(surface, sheet, 1e-3, OpenSides::two, side);
      expectHeld(report, surface.name + (side > 0 ? " front" : " back"));
      all.add(report);
    }
  }
  expectExact(all, "two-sided");
}

// Every node in the band of the triangles, by the nearest one, except at the boundary.
struct Sides {
  std::size_t wrong = 0, judged = 0;
};
Sides sidesOf(const SurfaceField& field, const TriangleMesh& mesh) {
  const ExactSurface sheet({mesh});
  const auto rim = rims(mesh);
  const double voxel = field.grid.voxel, band = field.band * voxel;
  Sides sides;
  for (int k = 0; k < field.grid.nodes[2]; ++k)
    for (int j = 0; j < field.grid.nodes[1]; ++j)
      for (int i = 0; i < field.grid.nodes[0]; ++i) {
        const double phi = static_cast<double>(test::phiAt(field, i, j, k));
        if (!(std::abs(phi) > 1e-3 && std::abs(phi) <= field.band)) continue;
        const Vec3 p = field.grid.toWorld(Vec3(i, j, k));
        const ExactSurface::Nearest at = sheet.nearest(p);
        Vec3 normal = Vec3::Zero();
        for (const Eigen::Matrix3d& t : sheet.trianglesNear(at.point, 1e-9))
          normal += (t.col(1) - t.col(0)).cross(t.col(2) - t.col(0)).normalized();
        if ((at.point - p).norm() > 0.999 * band || !(distanceTo(rim, at.point) > band)) continue;
        ++sides.judged;
        sides.wrong += (phi < 0) != ((at.point - p).dot(normal) > 0);
      }
  return sides;
}

// Steep waves, and sheets closer than their thickness.
std::vector<OpenSurface> awkwardSurfaces() {
  const int cells = 100;
  TriangleMesh waves = reliefBlock(kSide, -0.03, cells, [](double x, double y) {
    return 4e-3 * std::sin(400 * x) + 1e-3 * std::sin(300 * y);
  });
  const TriangleMesh flat = sheet(kSide, kSide, 6);
  return {{"waves", tilted(topOf(waves, cells)), {}},
          {"two sheets", tilted(joined(flat, moved(flat, Vec3(1e-4, 0, 6e-3)))), {}}};
}

TEST(OpenSurface, SignsAreUnambiguousEverywhere) {
  std::vector<OpenSurface> surfaces = openSurfaces();
  surfaces.pop_back(); // has an inside
  for (OpenSurface& surface : awkwardSurfaces()) surfaces.push_back(std::move(surface));
  for (const OpenSurface& surface : surfaces) {
    FieldSpec spec;
    spec.resolution = 100;
    Progress progress;
    const BuiltField built = buildField(surface.felt, spec, progress);
    const Sides sides = sidesOf(*built.field, surface.felt);
    std::printf("%-18s %zu unsure nodes, of %zu away from rims %zu wrong\n", surface.name.c_str(),
                built.report.ambiguous_signs, sides.judged, sides.wrong);
    EXPECT_EQ(built.report.open_triangles, surface.felt.triangles.size()) << surface.name;
    EXPECT_EQ(sides.wrong, 0U) << surface.name;
    EXPECT_GT(sides.judged, 10000U) << surface.name;
    EXPECT_EQ(built.report.ambiguous_signs, 0U) << surface.name;
  }
}

} // namespace
} // namespace patina::test
