#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "field/store/surface_field.h"
#include "geometry/atlas/texture_layout.h"
#include "picture/picture_support.h"
#include "support/painted_objects.h"
#include "visualization/view/picture.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr double kSide = 0.1, kRadius = 0.03;

class PaintPicture : public ::testing::Test {
 protected:
  void SetUp() override { PATINA_NEEDS_DISPLAY(); }

  void show(const std::vector<SceneObject>& objects) {
    scene_.objects = objects;
    TriangleMesh joint;
    for (const SceneObject& object : objects) {
      const TriangleMesh own =
          transformed(*object.mesh, Eigen::Affine3d(object.world_from_object.matrix()));
      joint = joint.triangles.empty() ? own : joined(joint, own);
    }
    view_.setMesh(std::make_shared<const TriangleMesh>(joint));
    view_.setPaint(scene_);
  }
  Pixels drawn(const std::string& name, const std::set<Layer>& layers,
               ViewPreset preset = ViewPreset::plus_z) {
    view_.showOnly(layers);
    view_.setView(preset);
    const char* keep = std::getenv("PATINA_KEEP_PICTURES");
    const fs::path folder = keep != nullptr ? fs::path(keep) : fs::temp_directory_path();
    const fs::path path = folder / ("paint_" + name + "-" + std::to_string(getpid()) + ".png");
    renderToPng(view_, {960, 720}, path);
    Pixels pixels(path);
    if (keep == nullptr)
      fs::remove(path);
    else
      fs::rename(path, folder / ("paint_" + name + ".png"));
    return pixels;
  }
  Scene scene_;
  SceneView view_;
};

bool isRed(const Vec3& c) {
  return c[0] > 1.8 * c[1] && c[0] > 1.8 * c[2] && c[0] > 60;
}

struct Spot {
  double area = 0; // pixels
  Vec2 centre = Vec2::Zero();
};
template <typename Test> Spot spotOf(const Pixels& pixels, Test test, double x0 = 0.14) {
  Spot spot;
  for (int y = 0; y < pixels.height(); ++y)
    for (int x = static_cast<int>(x0 * pixels.width()); x < pixels.width(); ++x)
      if (test(pixels.at(x, y))) {
        spot.area += 1;
        spot.centre += Vec2(x + 0.5, y + 0.5);
      }
  spot.centre /= std::max(1.0, spot.area);
  return spot;
}

SceneObject plateWithDisc(const Vec3& centre, double radius, int size) {
  SceneObject object = plate(kSide);
  ObjectPaint paint = paintOf(object);
  paint.color = imageOf(*object.mesh, *paint.layout.uvs, size, kColorChannels,
                        [&](const Vec3& p, float* rgba) {
                          if ((p - centre).norm() < radius) ink(rgba, {0.9, 0.05, 0.05});
                        });
  setPaint(object, paint);
  return object;
}

TEST_F(PaintPicture, DiscOnTwoTrianglesHasItsPlaceAndSize) { // K16
  constexpr int kSize = 256;
  const Vec3 centre(0.012, -0.021, 0);
  show({plateWithDisc(centre, 0.02, kSize)});
  const Pixels pixels = drawn("disc", {Layer::mesh, Layer::color});
  const Spot plate_spot = spotOf(
      pixels, [](const Vec3& c) { return isSurface(c) || isRed(c); }, 0.0);
  const double scale = kSide / std::sqrt(plate_spot.area); // metres a pixel
  const Spot disc = spotOf(pixels, isRed);
  const double texel = kSide / kSize;
  const Vec2 found = scale * (disc.centre - plate_spot.centre);
  EXPECT_NEAR(found[0], centre[0], texel);
  EXPECT_NEAR(found[1], centre[1], texel);
  EXPECT_NEAR(std::sqrt(disc.area * scale * scale / M_PI), 0.02, texel);
}

TEST_F(PaintPicture, ShowsThePlainObjectWithoutTheLayerOrPaint) {
  const SceneObject painted = plateWithDisc(Vec3::Zero(), 0.02, 128);
  show({painted});
  const Pixels off = drawn("off", {Layer::mesh});
  EXPECT_EQ(off.share(isRed), 0);
  SceneObject bare = painted;
  bare.paint = nullptr;
  show({bare});
  const Pixels plain =
      drawn("plain", {Layer::mesh, Layer::color, layerOf(quantityOf(MaterialChannel::stiffness)),
                      Layer::relief});
  for (int y = 0; y < plain.height(); y += 3)
    for (int x = 0; x < plain.width(); x += 3) ASSERT_EQ(plain.at(x, y), off.at(x, y));
}

// A seam would be a line of the object's own colour, or of a neighbour chart's.
TEST_F(PaintPicture, SpherePaintedInItsOwnColourLooksUnpainted) { // K16
  SceneObject sphere = objectOf(icosphere(kRadius, 12));
  show({sphere});
  const Pixels plain = drawn("sphere_plain", {Layer::mesh}, ViewPreset::iso);
  ObjectPaint paint;
  paint.layout = generateAtlas(*sphere.mesh, 256);
  EXPECT_GT(paint.layout.charts, 1);
  paint.color =
      imageOf(*sphere.mesh, *paint.layout.uvs, 256, kColorChannels, [](const Vec3&, float* rgba) {
        ink(rgba, {0.68, 0.80, 0.64});
      });
  paint.relief =
      imageOf(*sphere.mesh, *paint.layout.uvs, 256, 1, [](const Vec3&, float* g) { *g = 0.3F; });
  setPaint(sphere, paint);
  show({sphere});
  const Pixels pixels = drawn("sphere_same", {Layer::mesh, Layer::color}, ViewPreset::iso);
  double worst = 0;
  for (int y = 0; y < pixels.height(); ++y)
    for (int x = 0; x < pixels.width(); ++x)
      worst = std::max(worst, (pixels.at(x, y) - plain.at(x, y)).cwiseAbs().maxCoeff());
  EXPECT_LE(worst, 3);

  paint.color =
      imageOf(*sphere.mesh, *paint.layout.uvs, 256, kColorChannels, [](const Vec3&, float* rgba) {
        ink(rgba, {0.9, 0.05, 0.05});
      });
  setPaint(sphere, paint);
  show({sphere});
  const Pixels red = drawn("sphere_red", {Layer::mesh, Layer::color}, ViewPreset::iso);
  EXPECT_EQ(red.share(isSurface), 0);
  EXPECT_GT(red.share(isRed), 0.2);
}

// Shading by the image against a mesh that has the relief in its triangles (K21).
TEST_F(PaintPicture, ReliefIsShadedAsIfTheSurfaceWereDisplaced) {
  const auto height = [](const Vec3& p) { // rings, across all charts of the atlas
    return 0.0005 * std::sin(p.z() / 0.03 * 14) * std::exp(-8 * std::pow(p.z() / 0.03, 2));
  };
  SceneObject sphere = objectOf(icosphere(kRadius, 90));
  TriangleMesh displaced = *sphere.mesh;
  for (Vec3& p : displaced.positions) p += height(p) * p.normalized();
  ObjectPaint paint;
  paint.layout = generateAtlas(*sphere.mesh, 1024);
  scene_.relief.height = 0.001;
  paint.relief = imageOf(*sphere.mesh, *paint.layout.uvs, 1024, 1, [&](const Vec3& p, float* g) {
    *g = static_cast<float>(height(p) / 0.001);
  });
  setPaint(sphere, paint);
  show({objectOf(displaced)});
  const Pixels expected = drawn("displaced", {Layer::mesh}, ViewPreset::minus_y);
  show({objectOf(*sphere.mesh)});
  const Pixels smooth = drawn("smooth", {Layer::mesh}, ViewPreset::minus_y);
  show({sphere});
  const Pixels shaded = drawn("shaded", {Layer::mesh, Layer::color}, ViewPreset::minus_y);
  const auto difference = [&](const Pixels& a) {
    double sum = 0;
    for (int y = 180; y < 540; ++y)
      for (int x = 300; x < 660; ++x) sum += std::abs(a.at(x, y)[1] - expected.at(x, y)[1]);
    return sum / (360 * 360);
  };
  EXPECT_GT(difference(smooth), 4);
  EXPECT_LT(difference(shaded), 0.15 * difference(smooth));
}

TEST_F(PaintPicture, StiffnessColoursAPlateOfTwoTrianglesByItsMap) { // K22, K23
  SceneObject object = objectOf(sheet(kSide, kSide, 1));
  ObjectPaint paint;
  paint.material = materialOf(
      Box3(Vec3(-0.051, -0.051, -0.002), Vec3(0.051, 0.051, 0.002)), 0.001,
      MaterialChannel::stiffness, [](const Vec3&) { return 1000.0; },
      [](const Vec3& p) { return p.x() > 0.01; });
  setPaint(object, paint);
  show({object});
  const Pixels pixels =
      drawn("stiffness", {Layer::mesh, layerOf(quantityOf(MaterialChannel::stiffness))});
  EXPECT_EQ(view_.paintRange(quantityOf(MaterialChannel::stiffness)), (ValueRange{500, 1000}));
  const auto dark = [](const Vec3& c) { return c.maxCoeff() < 110 && c[2] > c[1]; };
  const auto pale = [](const Vec3& c) { return c[0] > 200 && c[2] < c[0] - 15; };
  const Spot stiff = spotOf(pixels, [&](const Vec3& c) { return dark(c); });
  EXPECT_GT(pixels.share(dark, 0.52, 0.75, 0.3, 0.7), 0.7);
  EXPECT_GT(pixels.share(pale, 0.2, 0.4, 0.3, 0.7), 0.95);
  EXPECT_GT(stiff.area, 1000);
  // The scale is there, and room for it.
  EXPECT_GT(pixels.share(dark, 0.88, 1, 0.2, 0.8), 0.01);
  EXPECT_GT(pixels.share(pale, 0.88, 1, 0.2, 0.8), 0.01);

  view_.setColors({{"stiffness", {.range = ValueRange{0, 4000}}}});
  const Pixels locked =
      drawn("stiffness_locked", {Layer::mesh, layerOf(quantityOf(MaterialChannel::stiffness))});
  EXPECT_EQ(view_.paintRange(quantityOf(MaterialChannel::stiffness)), (ValueRange{0, 4000}));
  EXPECT_EQ(locked.share(dark, 0.2, 0.8, 0.3, 0.7), 0);
}

TEST_F(PaintPicture, ReliefIsColouredByItsHeightWithAPaleZero) {
  SceneObject object = plate(kSide);
  ObjectPaint paint = paintOf(object);
  scene_.relief.height = 0.0005;
  paint.relief = imageOf(*object.mesh, *paint.layout.uvs, 512, 1, [](const Vec3& p, float* g) {
    const double up = (p - Vec3(0.02, 0.01, 0)).norm(), down = (p + Vec3(0.02, 0.01, 0)).norm();
    *g = static_cast<float>(std::max(0.0, 1 - std::pow(up / 0.015, 4)) -
                            std::max(0.0, 1 - std::pow(down / 0.015, 4)));
  });
  setPaint(object, paint);
  show({object});
  const Pixels pixels = drawn("relief", {Layer::mesh, Layer::relief});
  EXPECT_EQ(view_.paintRange(PaintQuantity::relief), (ValueRange{-0.0005, 0.0005}));
  const Spot up = spotOf(pixels, isCool), down = spotOf(pixels, isWarm);
  EXPECT_GT(pixels.share(isCool, 0.45, 0.75, 0.5, 0.75), 0.2);
  EXPECT_GT(pixels.share(isWarm, 0.2, 0.45, 0.25, 0.5), 0.2);
  EXPECT_GT(up.centre[0], down.centre[0]);
  EXPECT_EQ(pixels.share(isSurface, 0.14, 0.85), 0);
}

TEST_F(PaintPicture, OnlyPaintedObjectsHaveTheirOwnLayer) {
  SceneObject red = plateWithDisc(Vec3::Zero(), 1, 64);
  red.world_from_object.translation() = Vec3(-0.06, 0, 0);
  SceneObject bare = objectOf(sheet(kSide, kSide, 1));
  bare.name = "bare";
  bare.world_from_object.translation() = Vec3(0.06, 0, 0);
  show({red, bare});
  const Pixels pixels = drawn("two", {Layer::mesh, Layer::color});
  EXPECT_GT(pixels.share(isRed, 0.14, 0.45, 0.4, 0.6), 0.7);
  EXPECT_GT(pixels.share(isSurface, 0.55, 0.85, 0.4, 0.6), 0.95);
  EXPECT_EQ(pixels.share(isRed, 0.5, 1), 0);
}

TEST_F(PaintPicture, BrushIsVisibleOnLightAndDarkGround) {
  for (const double ground : {0.02, 0.98}) {
    SceneObject object = plate(kSide);
    ObjectPaint paint = paintOf(object);
    paint.color = imageOf(*object.mesh, *paint.layout.uvs, 64, kColorChannels,
                          [&](const Vec3&, float* rgba) { ink(rgba, Vec3::Constant(ground)); });
    setPaint(object, paint);
    show({object});
    const std::string name = ground < 0.5 ? "brush_dark" : "brush_light";
    const auto light = [](const Vec3& c) { return c.minCoeff() > 240; };
    const auto dark = [](const Vec3& c) { return c.maxCoeff() < 50; };
    view_.setBrush(std::nullopt);
    const Pixels before = drawn(name + "_none", {Layer::mesh, Layer::color});
    view_.setBrush(BrushCursorState{Vec3::Zero(), Vec3::UnitZ(), 0.02, 0.01, {1, 0, 0}});
    const Pixels after = drawn(name, {Layer::mesh, Layer::color});
    const auto more = [&](auto test) {
      return after.share(test, 0.2, 0.8) - before.share(test, 0.2, 0.8);
    };
    if (ground < 0.5)
      EXPECT_GT(more(light), 0.001);
    else
      EXPECT_GT(more(dark), 0.001);
    view_.setBrush(std::nullopt);
  }
}

TEST_F(PaintPicture, SliceShowsPaintedMaterial) {
  SceneObject object = objectOf(icosphere(kRadius, 20));
  ObjectPaint paint;
  paint.material = materialOf(
      Box3(Vec3::Constant(-0.04), Vec3::Constant(0.04)), 0.0008, MaterialChannel::stiffness,
      [](const Vec3& p) { return 500 + 30000 * std::max(0.0, p.x()); },
      [](const Vec3& p) { return std::abs(p.norm() - kRadius) < 0.005 && p.x() > 0; });
  setPaint(object, paint);
  show({object});
  FieldSpec spec;
  spec.resolution = 90;
  spec.band = 8;
  view_.setField(std::make_shared<SurfaceField>(sampleFunction(
      [](const Vec3& p) { return p.norm() - kRadius; },
      gridAround(Box3(Vec3::Constant(-kRadius), Vec3::Constant(kRadius)), spec), spec.band)));
  view_.setSlices({});
  const Pixels pixels =
      drawn("slice", {Layer::mesh, Layer::slice, layerOf(quantityOf(MaterialChannel::stiffness))},
            ViewPreset::minus_y);
  const auto dark = [](const Vec3& c) { return c.maxCoeff() < 130 && c[2] > c[0] + 10; };
  EXPECT_GT(pixels.share(dark, 0.55, 0.8, 0.35, 0.65), 0.05);
  EXPECT_EQ(pixels.share(dark, 0.14, 0.4, 0.35, 0.65), 0);
  EXPECT_EQ(pixels.share(isWarm, 0.14, 0.85), 0); // no distance where material is
}

} // namespace
} // namespace patina
