#include "authoring/relief_limits.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "authoring/relief_shapes.h"

namespace patina {
namespace {

using namespace test;

constexpr double kWidth = 0.1;
constexpr int kSize = 256;
constexpr double kTexel = kWidth / kSize;

// A sheet that fills the image, perhaps turned, sheared or stretched in it.
struct Sheet {
  TriangleMesh mesh = sheet(kWidth, kWidth, 8);
  TextureLayout layout;

  explicit Sheet(const Eigen::Matrix2d& uv_from_side = Eigen::Matrix2d::Identity()) {
    layout.uvs = uvsBy(mesh, [&](const Vec3& p) {
      return Vec2(uv_from_side * p.head<2>() / kWidth + Vec2::Constant(0.5));
    });
  }
};

Eigen::Matrix2d matrix(double a, double b, double c, double d) {
  Eigen::Matrix2d m;
  m << a, b, c, d;
  return m;
}

TiledImage smoothedOn(const Sheet& sheet, const TiledImage& image, double deviation) {
  return smoothed(image, sheet.mesh, sheet.layout,
                  texelMap(*sheet.layout.uvs, image.width(), image.height()), deviation);
}

// F7: a sine of amplitude A is as high as 2 b lambda^2 / (4 pi^2 P T) allows.
TEST(ReliefLimit, OfASineIsTheClosedForm) {
  const Sheet sheet;
  DeviceModel device;
  device.damping = 0.5;
  for (const double wavelength : {22 * kTexel, 60 * kTexel})
    for (const double angle : {0.0, 0.6, M_PI / 2}) {
      const double k = 2 * M_PI / wavelength, height = -0.2e-3;
      const Vec2 along(std::cos(angle), std::sin(angle));
      const auto image = reliefImage(
          kSize, [&](double u, double v) { return std::sin(k * kWidth * along.dot(Vec2(u, v))); });
      const ReliefLimit limit = reliefLimit(sheet.mesh, sheet.layout, *image, height, device);
      EXPECT_NEAR(limit.highest, 0.2e-3, 0.01 * 0.2e-3);
      EXPECT_NEAR(limit.curvature / (0.2e-3 * k * k), 1, 0.02);
      EXPECT_NEAR(limit.wavelength / wavelength, 1, 0.02);
      ASSERT_TRUE(limit.admissible);
      const double exact = 2 * 0.5 * wavelength * wavelength / (4 * M_PI * M_PI * 1e-3);
      EXPECT_NEAR(*limit.admissible / exact, 1, 0.02);
      device.delay = 2;
      EXPECT_NEAR(*reliefLimit(sheet.mesh, sheet.layout, *image, height, device).admissible / exact,
                  0.2, 0.004);
      device.delay = 0;
    }
}

// Along the surface: however the sheet lies in the image.
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
    const ReliefLimit limit = reliefLimit(sheet.mesh, sheet.layout, *image, 1e-3, std::nullopt);
    EXPECT_NEAR(limit.curvature / (1e-3 * k * k), 1, 0.02) << m;
    EXPECT_FALSE(limit.admissible);
  }
}

TEST(ReliefLimit, OfFlatReliefIsNone) {
  const Sheet sheet;
  const TiledImage empty(kSize, kSize, 1);
  const auto constant = reliefImage(kSize, [](double, double) { return 0.7; });
  const ReliefLimit none = reliefLimit(sheet.mesh, sheet.layout, empty, 1e-3, DeviceModel{});
  EXPECT_EQ(none.highest, 0);
  EXPECT_FALSE(none.admissible);
  const ReliefLimit flat = reliefLimit(sheet.mesh, sheet.layout, *constant, 1e-3, DeviceModel{});
  EXPECT_NEAR(flat.highest, 0.7e-3, 1e-9);
  EXPECT_EQ(flat.curvature, 0);
  EXPECT_FALSE(flat.admissible);
}

// The step from a chart to what lies beside it in the image is not on the surface.
TEST(ReliefLimit, DoesNotLookAcrossTheEdgeOfAChart) {
  const Sheet sheet(matrix(0.5, 0, 0, 0.5));
  const TexelMap texels = texelMap(*sheet.layout.uvs, kSize, kSize);
  const auto image = reliefImage(kSize, [&](double u, double v) {
    return texels.ownerAt(static_cast<int>(u * kSize), static_cast<int>(v * kSize)) >= 0 ? 0.0
                                                                                         : 1.0;
  });
  EXPECT_EQ(reliefLimit(sheet.mesh, sheet.layout, *image, 1e-3, std::nullopt).curvature, 0);
  const auto line = reliefImage(
      kSize, [](double u, double) { return static_cast<int>(u * kSize) == 128 ? 1.0 : 0.0; });
  EXPECT_NEAR(reliefLimit(sheet.mesh, sheet.layout, *line, 1e-3, std::nullopt).curvature,
              2e-3 / (4 * kTexel * kTexel), 0.01 * 1e-3 / (kTexel * kTexel));
}

double amplitudeAlong(const TiledImage& image, int from, int to) {
  float low = 1e9F, high = -1e9F;
  for (int j = from; j < to; ++j)
    for (int i = from; i < to; ++i) {
      low = std::min(low, image.at(i, j, 0));
      high = std::max(high, image.at(i, j, 0));
    }
  return 0.5 * static_cast<double>(high - low);
}

// exp(-2 pi^2 sigma^2 / lambda^2), in the middle where the sheet's edge is not seen.
TEST(SmoothedRelief, DampsAWaveAsAGaussianDoes) {
  const double wavelength = 24 * kTexel, k = 2 * M_PI / wavelength;
  for (const Eigen::Matrix2d& m :
       {matrix(1, 0, 0, 1), matrix(0, -1, 0.8, 0), matrix(0.9, 0.3, 0, 0.9)}) {
    const Sheet sheet(m);
    const Eigen::Matrix2d side_from_uv = m.inverse() * kWidth;
    for (const double ratio : {0.05, 0.125, 0.25}) {
      const double deviation = ratio * wavelength;
      for (const Vec2& along : {Vec2(1, 0), Vec2(0, 1), Vec2(0.6, -0.8)}) {
        const auto image = reliefImage(kSize, [&](double u, double v) {
          return std::cos(k * along.dot(side_from_uv * Vec2(u - 0.5, v - 0.5)));
        });
        const TiledImage after = smoothedOn(sheet, *image, deviation);
        const double kept = std::exp(-2 * M_PI * M_PI * ratio * ratio);
        EXPECT_NEAR(amplitudeAlong(after, 104, 152) / amplitudeAlong(*image, 104, 152), kept, 0.02)
            << ratio << "\n"
            << m << "\n"
            << along;
      }
    }
  }
}

TEST(SmoothedRelief, IsTheGaussianOfALine) {
  const Sheet sheet;
  const auto line = reliefImage(
      kSize, [](double u, double) { return static_cast<int>(u * kSize) == 128 ? 1.0 : 0.0; });
  const double texels = 4;
  const TiledImage after = smoothedOn(sheet, *line, texels * kTexel);
  for (int i = 104; i <= 152; ++i) {
    const double d = (i - 128) / texels;
    EXPECT_NEAR(static_cast<double>(after.at(i, 128, 0)),
                std::exp(-0.5 * d * d) / (texels * std::sqrt(2 * M_PI)), 1.5e-3);
  }
}

TEST(SmoothedRelief, KeepsConstantsAndWhatIsNotShown) {
  const TriangleMesh ball = icosphere(0.05, 12);
  const TextureLayout layout = textureLayout(ball, kSize);
  const TexelMap texels = texelMap(*layout.uvs, kSize, kSize);
  const auto image = reliefImage(kSize, [&](double u, double v) {
    const int i = static_cast<int>(u * kSize), j = static_cast<int>(v * kSize);
    return texels.ownerAt(i, j) >= 0 ? 0.7 : -3.0; // not read across a chart's edge
  });
  const TiledImage after = smoothed(*image, ball, layout, texels, 3e-3);
  for (int j = 0; j < kSize; ++j)
    for (int i = 0; i < kSize; ++i)
      ASSERT_NEAR(after.at(i, j, 0), image->at(i, j, 0), 1e-6) << i << " " << j;
  EXPECT_TRUE(same(smoothed(*image, ball, layout, texels, 0), *image));
}

// The heat that leaves a dab stays on its chart: the sum over the surface is kept.
TEST(SmoothedRelief, KeepsTheVolumeOfADab) {
  const Sheet sheet(matrix(0.8, 0.2, -0.1, 0.6));
  const auto dab = reliefImage(
      kSize, [](double u, double v) { return std::hypot(u - 0.6, v - 0.5) < 0.05 ? 1.0 : 0.0; });
  const TiledImage after = smoothedOn(sheet, *dab, 6e-3);
  double sum[2] = {0, 0};
  for (int j = 0; j < kSize; ++j)
    for (int i = 0; i < kSize; ++i) {
      sum[0] += static_cast<double>(dab->at(i, j, 0));
      sum[1] += static_cast<double>(after.at(i, j, 0));
    }
  EXPECT_NEAR(sum[1] / sum[0], 1, 1e-3);
}

// So that an edit stays local, whatever is smoothed.
TEST(SmoothedRelief, IsBitForBitTheSameFarFromAnEdit) {
  const Sheet sheet;
  const auto near = [](double u, double v, double x, double y) {
    return std::hypot(u - x, v - y) < 0.04 ? 1.0 : 0.0;
  };
  const auto one = reliefImage(kSize, [&](double u, double v) { return near(u, v, 0.2, 0.2); });
  const auto two = reliefImage(
      kSize, [&](double u, double v) { return near(u, v, 0.2, 0.2) + 0.5 * near(u, v, 0.8, 0.7); });
  const TiledImage a = smoothedOn(sheet, *one, 1e-3), b = smoothedOn(sheet, *two, 1e-3);
  for (int j = 0; j < 96; ++j)
    for (int i = 0; i < 96; ++i) ASSERT_EQ(a.at(i, j, 0), b.at(i, j, 0));
  EXPECT_GT(b.at(204, 179, 0), 0.4F);
  EXPECT_EQ(a.at(204, 179, 0), 0.0F);
}

TEST(SmoothedRelief, RefusesWhatMakesNoSense) {
  const Sheet sheet;
  const TiledImage image(kSize, kSize, 1), other(64, 64, 1);
  const TexelMap texels = texelMap(*sheet.layout.uvs, kSize, kSize);
  for (const double deviation : {-1e-3, static_cast<double>(NAN), static_cast<double>(INFINITY)})
    EXPECT_THROW(smoothed(image, sheet.mesh, sheet.layout, texels, deviation),
                 std::invalid_argument);
  EXPECT_THROW(smoothed(other, sheet.mesh, sheet.layout, texels, 1e-3), std::invalid_argument);
}

} // namespace
} // namespace patina
