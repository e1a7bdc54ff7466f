// Colours of a mesh file on its object, against the expected colour of each point.
#include "authoring/images/apply_colors.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/mesh/shapes.h"
#include "pictures/picture_file.h"
#include "support/fresh_folder.h"

namespace patina {
namespace {

Vec3 colorAt(const ObjectPaint& paint, std::size_t face, const Vec3& w) {
  const auto& uv = (*paint.layout.uvs)[face];
  const Vec2 at = w[0] * uv[0] + w[1] * uv[1] + w[2] * uv[2];
  Vec3 seen;
  for (int c = 0; c < 3; ++c) seen[c] = paint.color->sample(at.x(), at.y(), c);
  EXPECT_NEAR(paint.color->sample(at.x(), at.y(), 3), 1, 1e-6);
  return seen;
}

// Barycentric coordinates, uniform over a triangle except for a tenth along its edges.
Vec3 placeIn(std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  double u = share(random), v = share(random);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return 0.8 * Vec3(u, v, 1 - u - v) + Vec3::Constant(0.2 / 3);
}

class LayColors : public testing::Test {
 protected:
  void SetUp() override { folder_ = test::freshFolder("lay colors"); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Both ramps are linear, so values between texels are known: red to the right, green up.
  std::filesystem::path ramp(int side, float blue = 0) {
    Picture picture{side, side, 3, {}};
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i)
        for (const float value : {(static_cast<float>(i) + 0.5F) / static_cast<float>(side),
                                  (static_cast<float>(j) + 0.5F) / static_cast<float>(side), blue})
          picture.texel.push_back(value);
    const auto file = folder_ / (std::to_string(side) + "-" + std::to_string(blue) + ".exr");
    writePicture(file, picture);
    return file;
  }

  std::filesystem::path folder_;
  std::vector<std::string> warnings_;
};

TEST_F(LayColors, VertexColorsAreInterpolatedOverEachFace) {
  const TriangleMesh mesh = icosphere(0.03, 6);
  MeshColors colors;
  for (const Vec3& p : mesh.positions)
    colors.vertices.push_back({static_cast<float>(0.5 + p.x() / 0.06),
                               static_cast<float>(0.5 + p.y() / 0.06),
                               static_cast<float>(0.5 + p.z() / 0.06), 1});
  const auto paint = paintOf(mesh, colors, 512, warnings_);
  ASSERT_TRUE(paint && paint->color && !paint->relief && !paint->material);
  std::mt19937 random(1);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Vec3 w = placeIn(random);
    const Vec3 wanted =
        Vec3::Constant(0.5) + position(mesh, {static_cast<std::int32_t>(f), w}) / 0.06;
    EXPECT_LT((colorAt(*paint, f, w) - wanted).norm(), 0.004) << f;
  }
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(LayColors, FaceColorsAreConstantInside) {
  const TriangleMesh mesh = box(Vec3(0.05, 0.04, 0.03), 2);
  MeshColors colors;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    colors.faces.push_back({static_cast<float>(f % 5) / 4, static_cast<float>(f % 3) / 2,
                            static_cast<float>(f % 2), 1});
  const auto paint = paintOf(mesh, colors, 512, warnings_);
  ASSERT_TRUE(paint);
  std::mt19937 random(2);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (int trial = 0; trial < 20; ++trial) {
      const Vec3 seen = colorAt(*paint, f, placeIn(random));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(seen[c], static_cast<double>(colors.faces[f][static_cast<std::size_t>(c)]),
                    1e-6);
    }
}

// Each side of the box shows the whole picture: its own coordinates overlap six times.
TEST_F(LayColors, ReadsPicturesThroughOverlappingCoordinates) {
  TriangleMesh mesh = box(Vec3(0.05, 0.04, 0.03), 1);
  MeshColors colors;
  colors.pictures = {{ramp(64), {1, 1}, {0, 0}, true},
                     {ramp(64, 1), {0.5, 0.25}, {0.25, 0.5}, true}};
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    mesh.corner_uvs.push_back({Vec2(0.1, 0.1), Vec2(0.9, 0.2), Vec2(0.5, 0.9)});
    colors.picture_of.push_back(f < 6 ? 0 : 1);
  }
  const auto paint = paintOf(mesh, colors, 512, warnings_);
  ASSERT_TRUE(paint);
  EXPECT_TRUE(paint->layout.generated);
  std::mt19937 random(3);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (int trial = 0; trial < 20; ++trial) {
      const Vec3 w = placeIn(random);
      const auto& uv = mesh.corner_uvs[f];
      const Vec2 t = w[0] * uv[0] + w[1] * uv[1] + w[2] * uv[2];
      const Vec3 wanted =
          f < 6 ? Vec3(t.x(), t.y(), 0) : Vec3(0.5 * t.x() + 0.25, 0.25 * t.y() + 0.5, 1);
      EXPECT_LT((colorAt(*paint, f, w) - wanted).norm(), 0.006) << f;
    }
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(LayColors, PictureRepeatsOrIsClampedOutside) {
  TriangleMesh mesh = sheet(0.05, 0.05, 1);
  for (const bool repeats : {true, false}) {
    mesh.corner_uvs.assign(mesh.triangles.size(), {Vec2(1.2, 0.3), Vec2(1.8, 0.4), Vec2(1.5, 0.8)});
    MeshColors colors;
    colors.pictures = {{ramp(64), {1, 1}, {0, 0}, repeats}};
    colors.picture_of.assign(mesh.triangles.size(), 0);
    const auto paint = paintOf(mesh, colors, 512, warnings_);
    ASSERT_TRUE(paint);
    EXPECT_NEAR(colorAt(*paint, 0, Vec3::Constant(1.0 / 3)).x(), repeats ? 0.5 : 1, 0.01);
  }
}

TEST_F(LayColors, ImageOfThePictureSizeHasItsTexels) {
  TriangleMesh mesh = sheet(0.05, 0.05, 1);
  for (const Triangle& t : mesh.triangles) {
    auto& uv = mesh.corner_uvs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      uv[k] = mesh.positions[static_cast<std::size_t>(t[k])].head<2>() / 0.05 + Vec2(0.5, 0.5);
  }
  MeshColors colors;
  colors.pictures.push_back({ramp(1024), {1, 1}, {0, 0}, true});
  colors.picture_of.assign(mesh.triangles.size(), 0);
  const auto paint = paintOf(mesh, colors, 512, warnings_);
  ASSERT_TRUE(paint && !paint->layout.generated);
  ASSERT_EQ(paint->color->width(), 1024);
  for (int j = 0; j < 1024; j += 31)
    for (int i = 0; i < 1024; i += 29)
      EXPECT_NEAR(paint->color->at(i, j, 0), (static_cast<float>(i) + 0.5F) / 1024, 1e-5F);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(LayColors, TooFinePictureIsStoredCoarserWithAWarning) {
  TriangleMesh mesh = sheet(0.05, 0.05, 1);
  mesh.corner_uvs.assign(mesh.triangles.size(), {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)});
  mesh.corner_uvs[1] = {Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
  MeshColors colors;
  colors.pictures.push_back({ramp(kMaxColorTexels + 512), {1, 1}, {0, 0}, true});
  colors.picture_of.assign(mesh.triangles.size(), 0);
  const auto paint = paintOf(mesh, colors, 512, warnings_);
  ASSERT_TRUE(paint);
  EXPECT_EQ(paint->color->width(), kMaxColorTexels);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("more than 2048 texels a side"), std::string::npos);
}

// 2560 texels become 1280, which the image of 2048 takes whole.
TEST_F(LayColors, CoarserPictureKeepsItsPosition) {
  TriangleMesh mesh = sheet(0.05, 0.05, 1);
  mesh.corner_uvs = {{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}, {Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)}};
  MeshColors colors;
  colors.pictures.push_back({ramp(2560), {-1, 1}, {1, 0}, true});
  colors.picture_of.assign(mesh.triangles.size(), 0);
  const auto paint = paintOf(mesh, colors, 512, warnings_);
  ASSERT_TRUE(paint);
  EXPECT_EQ(paint->color->width(), 2048);
  for (int trial = 1; trial < 9; ++trial)
    EXPECT_NEAR(colorAt(*paint, 0, Vec3(1 - 0.1 * trial, 0.05 * trial, 0.05 * trial)).x(),
                1 - 0.05 * trial, 1e-3);
}

TEST_F(LayColors, FaceColorsAreStoredCoarserWithAWarningIfTexelsAreFew) {
  const TriangleMesh mesh = sheet(0.05, 0.05, 420);
  MeshColors colors;
  colors.faces.assign(mesh.triangles.size(), {1, 0, 0, 1});
  ASSERT_TRUE(paintOf(mesh, colors, 512, warnings_));
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("2048 x 2048"), std::string::npos);
}

TEST_F(LayColors, ImageIsNoSmallerThanTheSceneRequests) {
  const TriangleMesh mesh = box(Vec3(0.05, 0.04, 0.03), 1);
  MeshColors colors;
  colors.faces.assign(mesh.triangles.size(), {1, 0, 0, 1});
  for (const int least : {64, 1024, 4096})
    EXPECT_EQ(paintOf(mesh, colors, least, warnings_)->color->width(), least);
}

TEST_F(LayColors, UnreadablePictureLeavesTheFacesTheirColor) {
  TriangleMesh mesh = box(Vec3(0.05, 0.04, 0.03), 1);
  mesh.corner_uvs.assign(mesh.triangles.size(), {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)});
  MeshColors colors;
  colors.pictures.push_back({folder_ / "none.png", {1, 1}, {0, 0}, true});
  colors.picture_of.assign(mesh.triangles.size(), 0);
  EXPECT_EQ(paintOf(mesh, colors, 512, warnings_), nullptr);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("none.png"), std::string::npos);
  colors.faces.assign(mesh.triangles.size(), {0, 1, 0, 1});
  const auto paint = paintOf(mesh, colors, 512, warnings_);
  ASSERT_TRUE(paint);
  EXPECT_LT((colorAt(*paint, 3, Vec3::Constant(1.0 / 3)) - Vec3(0, 1, 0)).norm(), 1e-6);
}

TEST_F(LayColors, NonFiniteCoordinatesShowNothingAndLeaveOtherFacesIntact) {
  TriangleMesh mesh = box(Vec3(0.05, 0.04, 0.03), 1);
  mesh.corner_uvs.assign(mesh.triangles.size(), {Vec2(0.1, 0.1), Vec2(0.9, 0.1), Vec2(0.1, 0.9)});
  mesh.corner_uvs[0][1].x() = std::numeric_limits<double>::quiet_NaN();
  mesh.corner_uvs[1][1].x() = std::numeric_limits<double>::infinity();
  MeshColors colors;
  colors.pictures.push_back({ramp(64), {1e308, 1}, {1e308, 0}, true});
  colors.pictures.push_back({ramp(64), {1, 1}, {0, 0}, true});
  colors.picture_of.assign(mesh.triangles.size(), 1);
  colors.picture_of[2] = 0;
  const auto paint = paintOf(mesh, colors, 512, warnings_);
  ASSERT_TRUE(paint);
  for (int j = 0; j < paint->color->height(); ++j)
    for (int i = 0; i < paint->color->width(); ++i)
      for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(paint->color->at(i, j, c)));
  EXPECT_NEAR(colorAt(*paint, 5, Vec3::Constant(1.0 / 3)).x(), 1.1 / 3, 0.01);
}

TEST_F(LayColors, MeshWithoutColorsHasNoPaint) {
  EXPECT_EQ(paintOf(icosphere(0.03, 3), {}, 512, warnings_), nullptr);
  EXPECT_TRUE(warnings_.empty());
}

} // namespace
} // namespace patina
