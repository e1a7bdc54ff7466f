#include "acquisition/texture/fit_plane.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/mesh/shapes.h"
#include "scene/paint/relief_surface.h"

namespace patina {
namespace {

constexpr double kLength = 0.02, kHeight = 1e-3;
constexpr double kPlaneTurn = 2 * std::numbers::pi;

template <class Height> Picture pictureOf(int side, const Height& grey) {
  Picture picture{side, side, 1, {}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      picture.texel.push_back(
          static_cast<float>(grey(static_cast<double>(x) / side, static_cast<double>(y) / side)));
  return picture;
}
// Two products: waves along each axis, and one that goes across both.
double twoProducts(double x, double y) {
  return 0.5 + 0.2 * std::cos(kPlaneTurn * 3 * x) * std::cos(kPlaneTurn * 2 * y) +
         0.1 * std::sin(kPlaneTurn * 5 * x) *
             (std::sin(kPlaneTurn * y) + 0.5 * std::cos(kPlaneTurn * 7 * y));
}
FittedPlane fitted(const Picture& picture, PlaneFitOptions options) {
  options.length = kLength;
  options.height = kHeight;
  Progress progress;
  return fitPlane(picture, options, progress);
}
template <class Height> double worst(const FourierTexture& texture, const Height& due) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-0.05, 0.05);
  double most = 0;
  for (int i = 0; i < 500; ++i) {
    const double x = any(random), y = any(random);
    most = std::max(most, std::abs(height(texture, x, y) - due(x / kLength, y / kLength)));
  }
  return most;
}
double heightOf(double x, double y) {
  return kHeight * (twoProducts(x, y) - 0.5);
}

TEST(FitPlane, ReproducesAPictureOfWaves) {
  const Picture picture = pictureOf(64, twoProducts);
  PlaneFitOptions options;
  options.harmonics = 10;
  const FittedPlane plane = fitted(picture, options);
  EXPECT_EQ(plane.texture.kind, TextureKind::plane);
  EXPECT_EQ(problemOf(plane.texture), "");
  EXPECT_LT(worst(plane.texture, heightOf), 1e-9); // texels are floats: 6e-8 of 1 mm, and less
  EXPECT_LT(plane.residual, 1e-10);
  EXPECT_NEAR(plane.rms, kHeight * std::sqrt(0.04 / 4 + 0.01 / 4 * 1.25), 1e-9);

  options.rank = 0; // the smallest sufficient rank
  const FittedPlane products = fitted(picture, options);
  EXPECT_EQ(products.rank, 2);
  EXPECT_LT(products.relative_error, 1e-6);
  EXPECT_LT(worst(products.texture, heightOf), 1e-9);
  EXPECT_NEAR(products.texture.low, plane.texture.low, 1e-9);
}

// The best approximation of lower rank (Eckart & Young 1936) omits the other wave here.
TEST(FitPlane, LowerRankKeepsTheStrongerProduct) {
  PlaneFitOptions options;
  options.harmonics = 10;
  options.rank = 1;
  const FittedPlane one = fitted(pictureOf(64, twoProducts), options);
  EXPECT_EQ(one.rank, 1);
  const auto first = [](double x, double y) {
    return kHeight * 0.2 * std::cos(kPlaneTurn * 3 * x) * std::cos(kPlaneTurn * 2 * y);
  };
  EXPECT_LT(worst(one.texture, first), 1e-9);
  const double left = 0.01 / 4 * 1.25, all = 0.04 / 4 + left;
  EXPECT_NEAR(one.relative_error, std::sqrt(left / all), 1e-6);
  EXPECT_NEAR(one.residual, kHeight * std::sqrt(left), 1e-9);
}

TEST(FitPlane, BlendsNonPeriodicPictures) {
  const auto ramp = [](double x, double y) { return 0.3 + 0.3 * x + 0.2 * y * y; };
  PlaneFitOptions options;
  options.harmonics = 100;
  options.blend = 0.3;
  const FittedPlane plane = fitted(pictureOf(256, ramp), options);
  EXPECT_EQ(plane.samples, 255U) << "the last texel is the first one of the next period";
  // The seam has no step, unlike that of a picture without blending.
  const double before = height(plane.texture, -1e-6, 0.01),
               after = height(plane.texture, 1e-6, 0.01);
  EXPECT_NEAR(before, after, 1e-7);
  EXPECT_NEAR(height(plane.texture, 0.3 * kLength, 0.2 * kLength) -
                  height(plane.texture, 0.2 * kLength, 0.2 * kLength),
              kHeight * 0.03, 1e-6);
}

TEST(FitPlane, RejectsUnsuitablePictures) {
  const auto refuses = [](const Picture& picture, const char* part) {
    try {
      fitted(picture, {});
      ADD_FAILURE() << part;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refuses(Picture{8, 4, 1, std::vector<float>(32)}, "8 by 4");
  refuses(Picture{2, 2, 1, std::vector<float>(4)}, "fewer than 4");
  refuses(Picture{8, 8, 1, std::vector<float>(64, 0.5F)}, "as high everywhere");
  Picture odd = pictureOf(8, twoProducts);
  odd.texel[5] = NAN;
  refuses(odd, "no number");
}

// A17: one file on a sheet and on a body gives the picture's heights at the coordinates of each.
TEST(FitPlane, HasTheSameHeightsOnAnyMesh) {
  PlaneFitOptions options;
  options.harmonics = 10;
  for (const bool full : {true, false}) {
    options.rank = full ? std::nullopt : std::optional(0);
    TextureMappings laid;
    laid.library[4] = hapticTexture(fitted(pictureOf(64, twoProducts), options).texture);
    for (const TriangleMesh& mesh : {sheet(0.1, 0.1, 12), icosphere(0.03, 12)}) {
      laid.faces.clear();
      for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
        TexturedFace face;
        face.face = static_cast<std::int32_t>(f);
        face.texture = 4;
        for (int c = 0; c < 3; ++c)
          face.coords[static_cast<std::size_t>(c)] = mesh.corner(f, c).head<2>();
        laid.faces.push_back(face);
      }
      const TexturePatches patches(mesh, laid);
      for (std::size_t f = 0; f < mesh.triangles.size(); f += 7) {
        const Vec3 p = 0.5 * mesh.corner(f, 0) + 0.3 * mesh.corner(f, 1) + 0.2 * mesh.corner(f, 2);
        const PatchAt at = patches.at(static_cast<std::int32_t>(f), p);
        if (at.texture.weight < 1) continue; // at the boundary of the sheet
        EXPECT_NEAR(at.height, heightOf(p.x() / kLength, p.y() / kLength), 1e-9);
      }
    }
  }
}

} // namespace
} // namespace patina
