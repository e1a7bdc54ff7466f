#include "authoring/relief/relief_smoothing.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "authoring/relief_sheet.h"

namespace patina {
namespace {

using namespace test;

ReliefSmoother smoother(const TriangleMesh& mesh, const std::shared_ptr<const CornerUvs>& uvs,
                        int size, double deviation) {
  return {std::make_shared<const TriangleMesh>(mesh), uvs,
          std::make_shared<const TexelMap>(texelMap(*uvs, size, size)), deviation};
}

ReliefSmoother smootherOn(const Sheet& sheet, int size, double deviation) {
  return smoother(sheet.mesh, sheet.layout.uvs, size, deviation);
}

TiledImage smoothedOn(const Sheet& sheet, const TiledImage& image, double deviation) {
  return smootherOn(sheet, image.width(), deviation).smoothed(image);
}

constexpr double kTransferError = 0.013; // relative to the height of a wave

double amplitudeAlong(const TiledImage& image, int from, int to) {
  float low = 1e9F, high = -1e9F;
  for (int j = from; j < to; ++j)
    for (int i = from; i < to; ++i) {
      low = std::min(low, image.at(i, j, 0));
      high = std::max(high, image.at(i, j, 0));
    }
  return 0.5 * static_cast<double>(high - low);
}

// exp(-2 pi^2 sigma^2 / lambda^2), in the middle, far from the sheet's edge.
TEST(SmoothedRelief, DampsAWaveLikeAGaussian) {
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

// exp(-k^2 s^2 / 2) at each texel, also for waves as short as the internal step of wide smoothing.
TEST(SmoothedRelief, DampsEachWaveLikeAGaussianOfAnyWidth) {
  for (const Eigen::Matrix2d& m : {matrix(1, 0, 0, 1), matrix(0.9, 0.3, 0, 0.9)}) {
    const Sheet sheet(m);
    const Eigen::Matrix2d side_from_uv = m.inverse() * kWidth;
    for (const double texels : {1.5, 3.0, 6.0, 12.0, 20.0}) {
      const double deviation = texels * kTexel;
      const ReliefSmoother smooth = smootherOn(sheet, kSize, deviation);
      for (const double waves : {0.45, 0.6, 1.0, 3.0, 4.5, 8.0}) { // long, in deviations
        if (waves * texels < 2.5) continue;                        // not resolved by the texels
        const double k = 2 * M_PI / (waves * deviation);
        const double kept = std::exp(-0.5 * k * k * deviation * deviation);
        for (const Vec2& along : {Vec2(1, 0), Vec2(0, 1), Vec2(0.6, -0.8)}) {
          const auto image = reliefImage(kSize, [&](double u, double v) {
            return std::cos(k * along.dot(side_from_uv * Vec2(u - 0.5, v - 0.5)));
          });
          const TiledImage after = smooth.smoothed(*image);
          double worst = 0;
          for (int j = 112; j < 144; ++j)
            for (int i = 112; i < 144; ++i)
              worst = std::max(worst, std::abs(static_cast<double>(after.at(i, j, 0)) -
                                               kept * static_cast<double>(image->at(i, j, 0))));
          EXPECT_LE(worst, kTransferError) << texels << " texels, " << waves << " deviations\n"
                                           << m << "\n"
                                           << along;
        }
      }
    }
  }
}

// Texels that are twice as long in one half of the image as in the other.
TEST(SmoothedRelief, DampsWavesAlsoIfTexelsDifferInSize) {
  const Sheet sheet;
  CornerUvs uvs = *sheet.layout.uvs; // u = 1/2 stays, the left half takes a third of the image
  constexpr double kMiddle = 1.0 / 3;
  for (auto& corners : uvs)
    for (Vec2& uv : corners)
      uv[0] = uv[0] < 0.5 ? 2 * kMiddle * uv[0] : kMiddle + (1 - kMiddle) * (2 * uv[0] - 1);
  const auto along = [&](double u) { // [m] from the middle
    return kWidth * (u < kMiddle ? 0.5 * u / kMiddle - 0.5 : 0.5 * (u - kMiddle) / (1 - kMiddle));
  };
  const auto shared = std::make_shared<const CornerUvs>(uvs);
  for (const double texels : {2.0, 4.0, 8.0, 12.0}) {
    const double deviation = texels * kTexel;
    const ReliefSmoother smooth = smoother(sheet.mesh, shared, kSize, deviation);
    for (const double waves : {3.0, 4.5, 8.0}) {
      const double k = 2 * M_PI / (waves * deviation);
      const double kept = std::exp(-0.5 * k * k * deviation * deviation);
      const auto image =
          reliefImage(kSize, [&](double u, double) { return std::cos(k * along(u)); });
      const TiledImage after = smooth.smoothed(*image);
      double worst = 0;
      for (int i = 40; i < 200; ++i)
        worst = std::max(worst, std::abs(static_cast<double>(after.at(i, 128, 0)) -
                                         kept * static_cast<double>(image->at(i, 128, 0))));
      EXPECT_LE(worst, texels < 4 ? 0.07 : 0.03) << texels << " texels, " << waves << " deviations";
    }
  }
}

// Two charts side by side in the image that show distant parts of the surface.
TEST(SmoothedRelief, PassesNothingFromChartToChart) {
  Sheet sheet;
  CornerUvs uvs = *sheet.layout.uvs;
  for (auto& corners : uvs) {
    const double middle = (corners[0][0] + corners[1][0] + corners[2][0]) / 3;
    for (Vec2& uv : corners) uv[0] += middle < 0.5 ? 0.5 + 1.3 / kSize : -0.5 - 1.3 / kSize;
  }
  const auto shared = std::make_shared<const CornerUvs>(uvs);
  const auto image = reliefImage(kSize, [](double u, double) { return u < 0.5 ? 0.7 : -0.3; });
  for (const double texels : {1.0, 5.0, 30.0}) {
    const TiledImage after = smoother(sheet.mesh, shared, kSize, texels * kTexel).smoothed(*image);
    for (int j = 0; j < kSize; ++j)
      for (int i = 0; i < kSize; ++i)
        ASSERT_NEAR(after.at(i, j, 0), image->at(i, j, 0), 1e-6) << i << " " << j;
  }
}

// On faces sheared in opposite ways the heights stay in their range, without ringing.
TEST(SmoothedRelief, StaysWithinTheRangeOfHeightsOnSkewFaces) {
  const Sheet sheet;
  CornerUvs uvs = *sheet.layout.uvs;
  for (auto& corners : uvs)
    for (Vec2& uv : corners)
      uv[1] = 0.1 + 0.7 * (uv[1] + (static_cast<int>(std::lround(8 * uv[0])) % 2 ? 0.1 : 0.0));
  const auto shared = std::make_shared<const CornerUvs>(uvs);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(0, 1);
  const auto image = reliefImage(kSize, [&](double, double) { return at(random); });
  for (const double texels : {2.0, 10.0}) {
    const TiledImage after = smoother(sheet.mesh, shared, kSize, texels * kTexel).smoothed(*image);
    const TexelMap map = texelMap(uvs, kSize, kSize);
    for (int j = 0; j < kSize; ++j)
      for (int i = 0; i < kSize; ++i) {
        if (map.ownerAt(i, j) < 0) continue;
        ASSERT_GE(after.at(i, j, 0), -0.001F) << i << " " << j;
        ASSERT_LE(after.at(i, j, 0), 1.001F) << i << " " << j;
      }
  }
}

TEST(SmoothedRelief, MatchesTheGaussianOfALine) {
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

TEST(SmoothedRelief, KeepsConstantsAndUnusedTexels) {
  const TriangleMesh ball = icosphere(0.05, 12);
  const TextureLayout layout = textureLayout(ball, kSize);
  const TexelMap texels = texelMap(*layout.uvs, kSize, kSize);
  const auto image = reliefImage(kSize, [&](double u, double v) {
    const int i = static_cast<int>(u * kSize), j = static_cast<int>(v * kSize);
    return texels.ownerAt(i, j) >= 0 ? 0.7 : -3.0; // the smoother must not read these texels
  });
  const TiledImage after = smoother(ball, layout.uvs, kSize, 3e-3).smoothed(*image);
  for (int j = 0; j < kSize; ++j)
    for (int i = 0; i < kSize; ++i)
      ASSERT_NEAR(after.at(i, j, 0), image->at(i, j, 0), 1e-6) << i << " " << j;
  EXPECT_TRUE(same(smoother(ball, layout.uvs, kSize, 0).smoothed(*image), *image));
}

// Diffusion stays on the dab's chart: the sum over the surface is kept.
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

// An edit must stay local for any image.
TEST(SmoothedRelief, IsBitwiseUnchangedFarFromAnEdit) {
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

// A stroke over charts, gutters and the image's border, raised, engraved and erased.
TEST(SmoothedRelief, UpdateAroundAnEditIsBitwiseEqualToTheWholeImage) {
  struct Case {
    TriangleMesh mesh;
    std::shared_ptr<const CornerUvs> uvs;
    double deviation;
  };
  const TriangleMesh ball = icosphere(0.03, 7);
  const Sheet sheet, sheared(matrix(0.6, 0.3, 0, 0.6));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(0, 1);
  for (const Case& one : {Case{ball, textureLayout(ball, kSize).uvs, 0.4e-3},
                          {sheet.mesh, sheet.layout.uvs, 0.9e-3},
                          {ball, textureLayout(ball, kSize).uvs, 3e-3},
                          {sheared.mesh, sheared.layout.uvs, 1.5e-3},
                          {sheared.mesh, sheared.layout.uvs, 2.5e-3}}) {
    const ReliefSmoother kept = smoother(one.mesh, one.uvs, kSize, one.deviation);
    TiledImage before(kSize, kSize, 1), result = kept.smoothed(before);
    std::size_t shared = 0;
    for (int dab = 0; dab < 12; ++dab) {
      TiledImage relief = before;
      const double value = dab % 4 == 3 ? 0 : at(random) - 0.4; // the last of four erases
      for (int spot = 0; spot <= dab % 3; ++spot) {             // like a brush across a seam
        const int ci = static_cast<int>(at(random) * kSize),
                  cj = static_cast<int>(at(random) * kSize);
        for (int j = std::max(cj - 9, 0); j < std::min(cj + 10, kSize); ++j)
          for (int i = std::max(ci - 9, 0); i < std::min(ci + 10, kSize); ++i)
            if (std::hypot(i - ci, j - cj) < 9)
              relief.writable(relief.tileOf(i, j))[relief.offsetOf(i, j)] =
                  static_cast<float>(value * (1 + 0.1 * at(random)));
      }
      const TiledImage next = kept.updateSmoothed(result, before, relief);
      ASSERT_TRUE(same(next, smoother(one.mesh, one.uvs, kSize, one.deviation).smoothed(relief)))
          << dab;
      for (std::size_t t = 0; t < next.tileCount(); ++t)
        shared += next.sharedTile(t) && next.sharedTile(t) == result.sharedTile(t);
      before = relief;
      result = next;
    }
    EXPECT_GT(shared, 12U); // tiles far from all dabs are reused
  }
}

TEST(SmoothedRelief, RejectsInvalidInput) {
  const Sheet sheet;
  const TiledImage other(64, 64, 1);
  for (const double deviation : {-1e-3, static_cast<double>(NAN), static_cast<double>(INFINITY)})
    EXPECT_THROW((void)smootherOn(sheet, kSize, deviation), std::invalid_argument);
  EXPECT_THROW((void)smootherOn(sheet, kSize, 1e-3).smoothed(other), std::invalid_argument);
}

} // namespace
} // namespace patina
