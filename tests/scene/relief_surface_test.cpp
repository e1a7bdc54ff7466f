#include "scene/paint/relief_surface.h"

#include <gtest/gtest.h>

#include "field/analytic_fields.h"
#include "geometry/tree/triangle_tree.h"
#include "support/painted_shapes.h"
#include "support/relief_image.h"

namespace patina {
namespace {

constexpr double kSide = Slab::kSide;

// A smooth image; its height and slope on the slab in closed form.
double wave(double u, double v) {
  return std::sin(11 * u) * std::cos(7 * v);
}
Vec2 waveSlope(double u, double v) {
  return {11 * std::cos(11 * u) * std::cos(7 * v), -7 * std::sin(11 * u) * std::sin(7 * v)};
}

// A face of the slab's top.
std::int32_t topOf(const Slab& plane) {
  for (std::size_t f = 0; f < plane.mesh->triangles.size(); ++f)
    if (faceNormal(*plane.mesh, f).z() > 0.5) return static_cast<std::int32_t>(f);
  return -1;
}

TEST(ReliefSurface, HeightAndSlopeConvergeWithTheTexel) {
  const Slab& plane = fineSlab();
  const double s = 2e-3;
  std::vector<double> height_error, slope_error;
  for (const int size : {64, 128, 256}) {
    const auto relief = reliefOn(plane.faces, test::reliefImage(size, wave), s);
    double worst = 0, worst_slope = 0;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> in(-0.45 * kSide, 0.45 * kSide);
    for (int i = 0; i < 4000; ++i) {
      const Vec3 c(in(random), in(random), 0);
      const double u = c.x() / kSide + 0.5, v = c.y() / kSide + 0.5;
      const ReliefAt at = reliefAt(*relief, c, topOf(plane));
      const Vec2 slope = s / kSide * waveSlope(u, v);
      worst = std::max(worst, std::abs(at.height - s * wave(u, v)));
      worst_slope = std::max(worst_slope, (at.slope() - Vec3(slope.x(), slope.y(), 0)).norm());
    }
    height_error.push_back(worst);
    slope_error.push_back(worst_slope);
  }
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_GT(std::log2(height_error[i - 1] / height_error[i]), 2.8);
    EXPECT_GT(std::log2(slope_error[i - 1] / slope_error[i]), 1.8);
  }
  EXPECT_LT(height_error.back(), 1e-6 * s * 10);
}

// The slope is the derivative of the height, across texels and tiles.
TEST(ReliefSurface, SlopeIsTheDerivativeOfTheHeightAlsoForNoise) {
  const Slab& plane = fineSlab();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> g(-1, 1), in(-0.49 * kSide, 0.49 * kSide);
  const auto relief =
      reliefOn(plane.faces, test::reliefImage(96, [&](double, double) { return g(random); }), 1e-3);
  const double e = 1e-8;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 c(in(random), in(random), 0);
    const ReliefAt at = reliefAt(*relief, c, topOf(plane));
    const auto h = [&](double dx, double dy) {
      return reliefAt(*relief, c + Vec3(dx, dy, 0), at.face).height;
    };
    ASSERT_NEAR(at.slope().x(), (h(e, 0) - h(-e, 0)) / (2 * e), 1e-4);
    ASSERT_NEAR(at.slope().y(), (h(0, e) - h(0, -e)) / (2 * e), 1e-4);
    ASSERT_EQ(at.slope().z(), 0);
  }
}

TEST(ReliefSurface, IsFlatWhereTheImageHasNoTiles) {
  const Slab& plane = fineSlab();
  const auto relief = reliefOn(plane.faces, std::make_shared<TiledImage>(64, 64, 1), 1e-3);
  const ReliefAt at = reliefAt(*relief, Vec3(1e-3, 2e-3, 0), topOf(plane));
  EXPECT_EQ(at.height, 0);
  EXPECT_TRUE(at.slope().isZero(0));
  EXPECT_GE(at.face, 0);
}

TEST(ReliefSurface, MissingFaceHasNoHeight) {
  const Slab& plane = fineSlab();
  const auto relief =
      reliefOn(plane.faces, test::reliefImage(64, [](double, double) { return 1; }), 1e-3);
  for (const int face : {-1, 1 << 30}) EXPECT_EQ(reliefAt(*relief, Vec3::Zero(), face).face, -1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(reliefAt(*relief, Vec3(0, nan, 0), 0).height, 0);
}

// A walk over the faces ends at the closest one: as near as the tree's answer, from points near
// the surface, starting some faces away.
TEST(ReliefSurface, WalkFindsTheClosestFace) {
  const TriangleMesh mesh = vase();
  const TriangleTree tree(mesh);
  const auto faces = reliefFaces(mesh, CornerUvs(mesh.triangles.size()));
  const auto relief =
      reliefOn(faces, test::reliefImage(64, [](double, double) { return 1; }), 1e-3);
  std::mt19937 random(3);
  std::uniform_int_distribution<std::size_t> any(0, mesh.triangles.size() - 1);
  std::uniform_real_distribution<double> share(0, 1), off(-2e-4, 2e-4);
  int lost = 0;
  const int count = 20000;
  for (int i = 0; i < count; ++i) {
    const std::size_t f = any(random);
    double a = share(random), b = share(random);
    if (a + b > 1) {
      a = 1 - a;
      b = 1 - b;
    }
    const Vec3 on = mesh.corner(f, 0) + a * (mesh.corner(f, 1) - mesh.corner(f, 0)) +
                    b * (mesh.corner(f, 2) - mesh.corner(f, 0));
    const Vec3 c = on + off(random) * faceNormal(mesh, f);
    // A start up to 2 mm away along the surface.
    const auto start = tree.closestPoint(
        c + 2e-3 * share(random) * test::randomDirection(random).cross(faceNormal(mesh, f)));
    const double wanted = tree.closestPoint(c).distance;
    const ReliefAt at = reliefAt(*relief, c, start.surface.face);
    lost += at.distance > wanted + 1e-8;
  }
  std::printf("%d of %d walks end on another face than the closest\n", lost, count);
  // In a concave corner the walk may end on the wall where it began; the stage detects the distance
  // and starts again.
  EXPECT_LT(lost, count / 100);
}

// Along a path each face leads to the next one, over edges, boundaries and vertices.
TEST(ReliefSurface, WalkAlongAPathStaysOnTheSurface) {
  const TriangleMesh mesh = icosphere(0.03, 40);
  const TriangleTree tree(mesh);
  const auto faces = reliefFaces(mesh, CornerUvs(mesh.triangles.size()));
  const auto relief =
      reliefOn(faces, test::reliefImage(64, [](double, double) { return 1; }), 1e-3);
  std::int32_t face = tree.closestPoint(Vec3(0, 0, 0.03)).surface.face;
  for (int i = 0; i < 20000; ++i) { // 0.3 mm a step, over every vertex there is
    const double a = 0.01 * i, b = 0.0007 * i;
    const Vec3 c = 0.0301 * Vec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b));
    const ReliefAt at = reliefAt(*relief, c, face);
    ASSERT_LT(at.distance, tree.closestPoint(c).distance + 1e-8);
    face = at.face;
  }
}

} // namespace
} // namespace patina
