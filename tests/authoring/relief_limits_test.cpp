#include "authoring/relief/relief_limits.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "authoring/relief_sheet.h"

namespace patina {
namespace {

using namespace test;

// F7: a sine of amplitude A is as high as 2 b lambda^2 / (4 pi^2 P T) allows.
TEST(ReliefLimit, MatchesTheClosedFormForASine) {
  const Sheet sheet;
  DeviceModel device;
  device.damping = 0.5;
  const double press = 2.5;
  for (const double wavelength : {22 * kTexel, 60 * kTexel})
    for (const double angle : {0.0, 0.6, M_PI / 2}) {
      const double k = 2 * M_PI / wavelength, height = -0.2e-3;
      const Vec2 along(std::cos(angle), std::sin(angle));
      const auto image = reliefImage(
          kSize, [&](double u, double v) { return std::sin(k * kWidth * along.dot(Vec2(u, v))); });
      const ReliefLimit limit =
          reliefLimit(sheet.mesh, sheet.layout, *image, height, device, press);
      EXPECT_NEAR(limit.highest, 0.2e-3, 0.01 * 0.2e-3);
      EXPECT_NEAR(limit.curvature / (0.2e-3 * k * k), 1, 0.02);
      EXPECT_NEAR(limit.wavelength / wavelength, 1, 0.02);
      ASSERT_TRUE(limit.admissible);
      const double exact = 2 * 0.5 * wavelength * wavelength / (4 * M_PI * M_PI * press * 1e-3);
      EXPECT_NEAR(*limit.admissible / exact, 1, 0.02);
      device.delay = 2;
      EXPECT_NEAR(*reliefLimit(sheet.mesh, sheet.layout, *image, height, device, press).admissible /
                      exact,
                  0.2, 0.004);
      device.delay = 0;
    }
}

// Curvature is measured along the surface, for any orientation of the sheet in the image.
TEST(ReliefLimit, DoesNotDependOnTheLayout) {
  const double wavelength = 0.03, k = 2 * M_PI / wavelength;
  for (const Eigen::Matrix2d& m : {matrix(1, 0, 0, 1), matrix(0, -0.5, 0.9, 0),
                                   matrix(0.6, 0.3, 0, 0.6), matrix(0.5, 0.5, -0.3, 0.3)}) {
    const Sheet sheet(m);
    const Eigen::Matrix2d side_from_uv = m.inverse() * kWidth;
    const auto image = reliefImage(kSize, [&](double u, double v) {
      const Vec2 side = side_from_uv * Vec2(u - 0.5, v - 0.5);
      return std::cos(k * (0.8 * side[0] + 0.6 * side[1]));
    });
    const ReliefLimit limit = reliefLimit(sheet.mesh, sheet.layout, *image, 1e-3, std::nullopt, 1);
    EXPECT_NEAR(limit.curvature / (1e-3 * k * k), 1, 0.02) << m;
    EXPECT_FALSE(limit.admissible);
  }
}

// A texel changed on the corner of a tile affects all four tiles.
TEST(CurvatureMap, IncrementalUpdateEqualsTheWholeImage) {
  const Sheet sheet(matrix(0.6, 0.3, 0, 0.6));
  const CurvatureMap map(std::make_shared<const TriangleMesh>(sheet.mesh), sheet.layout.uvs, kSize,
                         kSize);
  std::mt19937 random(3);
  std::uniform_int_distribution<int> tile(2, kSize / kTileSide - 3), within(0, kTileSide - 1);
  TiledImage image = *reliefImage(kSize, [](double u, double v) { return std::sin(20 * u * v); });
  std::vector<float> known = map.perTile(image);
  int seen = 0;
  for (int i = 0; i < 20; ++i) {
    const TiledImage before = image.published();
    const int at = i < 4 ? 0 : within(random);
    const int x = kTileSide * tile(random) + at, y = kTileSide * tile(random) + at;
    image.writable(image.tileOf(x, y))[image.offsetOf(x, y)] += 1;
    const std::vector<float> whole = map.perTile(image);
    seen += whole != known;
    known = map.perTile(image, &before, &known);
    EXPECT_EQ(known, whole);
  }
  EXPECT_GT(seen, 10); // tiles without the sheet do not count
}

TEST(ReliefLimit, IsAbsentForFlatRelief) {
  const Sheet sheet;
  const TiledImage empty(kSize, kSize, 1);
  const auto constant = reliefImage(kSize, [](double, double) { return 0.7; });
  const ReliefLimit none = reliefLimit(sheet.mesh, sheet.layout, empty, 1e-3, DeviceModel{}, 1);
  EXPECT_EQ(none.highest, 0);
  EXPECT_FALSE(none.admissible);
  const ReliefLimit flat = reliefLimit(sheet.mesh, sheet.layout, *constant, 1e-3, DeviceModel{}, 1);
  EXPECT_NEAR(flat.highest, 0.7e-3, 1e-9);
  EXPECT_EQ(flat.curvature, 0);
  EXPECT_FALSE(flat.admissible);
}

// The step at the edge of a chart in the image is not on the surface.
TEST(ReliefLimit, IgnoresTexelsBeyondTheChartEdge) {
  const Sheet sheet(matrix(0.5, 0, 0, 0.5));
  const TexelMap texels = texelMap(*sheet.layout.uvs, kSize, kSize);
  const auto image = reliefImage(kSize, [&](double u, double v) {
    return texels.ownerAt(static_cast<int>(u * kSize), static_cast<int>(v * kSize)) >= 0 ? 0.0
                                                                                         : 1.0;
  });
  EXPECT_EQ(reliefLimit(sheet.mesh, sheet.layout, *image, 1e-3, std::nullopt, 1).curvature, 0);
  const auto line = reliefImage(
      kSize, [](double u, double) { return static_cast<int>(u * kSize) == 128 ? 1.0 : 0.0; });
  EXPECT_NEAR(reliefLimit(sheet.mesh, sheet.layout, *line, 1e-3, std::nullopt, 1).curvature,
              2e-3 / (4 * kTexel * kTexel), 0.01 * 1e-3 / (kTexel * kTexel));
}

} // namespace
} // namespace patina
