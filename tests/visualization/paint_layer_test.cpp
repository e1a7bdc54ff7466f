#include "visualization/layers/paint_layer.h"

#include <random>

#include <gtest/gtest.h>

#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include "geometry/atlas/texture_layout.h"
#include "scene/painted_value.h"
#include "scene/relief_slope.h"
#include "scene/surface_pick.h"
#include "support/least_time.h"
#include "support/one_thread.h"
#include "support/painted_objects.h"
#include "visualization/layers/image_surface.h"

namespace patina {
namespace {

TEST(PaintColors, MaterialGetsDarkerInEqualSteps) {
  const auto table = paintColors(quantityOf(MaterialChannel::stiffness), {0, 254});
  Vec3 before = Vec3::Zero();
  std::vector<double> steps;
  for (int i = 0; i <= 12; ++i) {
    double rgb[3];
    table->GetColor(21 * i + 0.5, rgb);
    Vec3 lab;
    vtkMath::RGBToLab(rgb, lab.data());
    if (i > 0) {
      EXPECT_LT(lab[0], before[0] - 2) << i;
      steps.push_back((lab - before).norm());
    }
    before = lab;
  }
  const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
  EXPECT_LT(*most, 1.35 * *least); // a step over a station cuts its corner
}

TEST(PaintColors, ReliefIsPaleAtZeroForEveryRange) {
  for (const ValueRange range :
       {ValueRange{-1e-3, 1e-3}, ValueRange{0, 5e-4}, ValueRange{-1e-4, 8e-4}}) {
    const auto table = paintColors(PaintQuantity::relief, range);
    double at_zero[3], at_top[3];
    table->GetColor(0, at_zero);
    table->GetColor(range.high, at_top);
    EXPECT_LT(std::abs(at_zero[0] - at_zero[2]), 0.06);
    EXPECT_GT(at_zero[1], 0.8);
    EXPECT_GT(at_top[2], at_top[0] + 0.3); // outward is cool, as in the distance map
  }
}

TEST(PaintQuantity, RangesHaveRoundEndsAndContainTheirValues) {
  EXPECT_EQ(rounded({500, 1000}), (ValueRange{500, 1000}));
  EXPECT_EQ(rounded({0, 0.0005}), (ValueRange{0, 0.0005}));
  for (const ValueRange range : {ValueRange{500, 500}, ValueRange{0, 0}, ValueRange{-0.37, 1.91},
                                 ValueRange{1e-7, 3e5}, ValueRange{-5, -4.99}}) {
    const ValueRange round = rounded(range);
    EXPECT_LE(round.low, range.low + 1e-5 * (round.high - round.low));
    EXPECT_GE(round.high, range.high - 1e-5 * (round.high - round.low));
    EXPECT_GT(round.high, round.low);
  }
  EXPECT_EQ(arrayName(quantityOf(MaterialChannel::damping)), "damping [N s/m]");
  EXPECT_EQ(arrayName(quantityOf(MaterialChannel::static_friction)), "friction.static");
  EXPECT_EQ(readingUnit(quantityOf(MaterialChannel::static_friction), {0, 1}).title,
            "static friction");
  EXPECT_EQ(readingUnit(quantityOf(MaterialChannel::damping), {0, 1}).title, "damping [N s/m]");
  EXPECT_EQ(readingUnit(PaintQuantity::relief, {0, 5e-4}).display_per_si, 1e3);
  EXPECT_EQ(readingUnit(quantityOf(MaterialChannel::roughness), {0, 2e-5}).display_per_si, 1e6);
}

// g linear in space: its gradient along the surface is the tangent part, up to every edge.
TEST(ReliefSlope, EqualsTheTangentGradientUpToTheEdgesOfCharts) {
  const TriangleMesh mesh = icosphere(0.03, 10);
  const TextureLayout layout = generateAtlas(mesh, 256);
  ASSERT_GT(layout.charts, 1);
  const Vec3 gradient(12, -7, 20);
  const auto image = imageOf(mesh, *layout.uvs, 256, 1, [&](const Vec3& p, float* g) {
    *g = static_cast<float>(gradient.dot(p));
  });
  const TexelMap texels = texelMap(*layout.uvs, 256, 256);
  const ReliefSlope slope(mesh, *layout.uvs, texels);
  int shown = 0;
  double worst = 0;
  for (int j = 0; j < 256; ++j)
    for (int i = 0; i < 256; ++i) {
      const std::int32_t face = texels.ownerAt(i, j);
      if (face < 0) {
        EXPECT_EQ(slope.at(*image, i, j), Vec3::Zero());
        continue;
      }
      const Vec3 n = faceNormal(mesh, static_cast<std::size_t>(face));
      const Vec3 tangent = gradient - gradient.dot(n) * n;
      const double error = (slope.at(*image, i, j) - tangent).norm();
      worst = std::max(worst, error);
      ++shown;
    }
  EXPECT_GT(shown, 20000);
  // The faces meet at 6 degrees, so that a difference across an edge has that error.
  EXPECT_LT(worst, 0.2 * gradient.norm());
}

TEST(ReliefSlope, EncodingIsFineNearZeroAndEndsAtTheSteepest) {
  const auto decoded = [](unsigned char byte) {
    const double root = (byte - 128) / 127.0;
    return kMaxEncodedSlope * root * std::abs(root);
  };
  EXPECT_EQ(encodedSlope(Vec3::Zero()), (std::array<unsigned char, 3>{128, 128, 128}));
  for (double s = -1.9; s < 2; s += 0.0371) {
    const double back = decoded(encodedSlope(Vec3(s, 0, 0))[0]);
    EXPECT_NEAR(back, s, 0.002 + 0.012 * std::sqrt(std::abs(s)));
  }
  EXPECT_EQ(encodedSlope(Vec3(99, -99, 0))[0], 255);
  EXPECT_EQ(encodedSlope(Vec3(99, -99, 0))[1], 1);
}

TEST(ImageTiles, ChangeOnlyWhereWritten) {
  const TiledImage before(128, 128, 1);
  TiledImage after = before;
  EXPECT_TRUE(changedTiles(&before, after).empty());
  after.writable(5)[0] = 1;
  EXPECT_EQ(changedTiles(&before, after), std::vector<std::size_t>{5});
  TiledImage again = after;
  again.writable(5)[1] = 2;
  again.writable(0);
  EXPECT_EQ(changedTiles(&after, again), (std::vector<std::size_t>{0, 5}));
  EXPECT_EQ(changedTiles(nullptr, after).size(), 16U);
  EXPECT_EQ(changedTiles(&before, TiledImage(64, 64, 1)).size(), 4U);
}

TEST(MaterialPlaces, AreTheChangedBlocksOfTheChannel) {
  MaterialMap before(Vec3::Zero(), 0.001);
  before.writable({0, 0, 0}, MaterialChannel::stiffness).weight[0] = 1;
  MaterialMap after = before;
  const auto none = changedPlaces(&before, after, MaterialChannel::stiffness);
  ASSERT_TRUE(none.has_value());
  EXPECT_TRUE(none->empty());
  after.writable({2, 0, 0}, MaterialChannel::damping).weight[0] = 1;
  EXPECT_TRUE(changedPlaces(&before, after, MaterialChannel::stiffness)->empty());
  const auto damping = changedPlaces(&before, after, MaterialChannel::damping);
  ASSERT_EQ(damping->size(), 1U);
  EXPECT_TRUE(damping->front().contains(Vec3(0.0155, 0, 0)));
  EXPECT_FALSE(damping->front().contains(Vec3(0.0145, 0, 0)));
  // After undo the block is absent.
  EXPECT_EQ(changedPlaces(&after, before, MaterialChannel::damping)->size(), 1U);
  EXPECT_FALSE(changedPlaces(nullptr, after, MaterialChannel::damping).has_value());
}

Scene paintedScene(int size) {
  Scene scene;
  SceneObject object = objectOf(icosphere(0.03, 16));
  ObjectPaint paint;
  paint.layout = generateAtlas(*object.mesh, size);
  paint.color =
      imageOf(*object.mesh, *paint.layout.uvs, size, kColorChannels, [](const Vec3&, float* rgba) {
        ink(rgba, {1, 0, 0});
      });
  paint.relief = imageOf(*object.mesh, *paint.layout.uvs, size, 1,
                         [](const Vec3& p, float* g) { *g = static_cast<float>(10 * p.x()); });
  paint.material = materialOf(
      Box3(Vec3::Constant(-0.032), Vec3::Constant(0.032)), 0.0005, MaterialChannel::stiffness,
      [](const Vec3& p) { return 600 + 1e4 * p.z(); },
      [](const Vec3& p) { return std::abs(p.norm() - 0.03) < 0.003; });
  setPaint(object, paint);
  scene.objects = {object};
  return scene;
}

// One dab of a brush of 5 % of the object: a few tiles, a few blocks.
Scene dabbed(const Scene& scene) {
  Scene after = scene;
  ObjectPaint paint = *scene.objects[0].paint;
  auto color = std::make_shared<TiledImage>(*paint.color);
  auto relief = std::make_shared<TiledImage>(*paint.relief);
  const auto across = static_cast<std::size_t>(color->tilesAcross());
  for (std::size_t tile : {across + 1, across + 2, 2 * across + 1, 2 * across + 2}) {
    color->writable(tile)[0] *= 0.5F;
    relief->writable(tile)[0] += 0.01F;
  }
  paint.color = color;
  paint.relief = relief;
  auto map = std::make_shared<MaterialMap>(*paint.material);
  std::vector<MaterialMap::Index> blocks;
  for (const auto& [index, block] : map->blocks())
    if (blocks.size() < 8) blocks.push_back(index);
  for (const MaterialMap::Index& index : blocks)
    map->writable(index, MaterialChannel::stiffness).value[0] += 1;
  paint.material = map;
  setPaint(after.objects[0], paint);
  return after;
}

double milliseconds(const std::function<void()>& work) {
  const double begin = test::threadSeconds();
  work();
  return 1e3 * (test::threadSeconds() - begin);
}

PATINA_TIMED_TEST(PaintLayer, ADabCostsAFractionOfDrawingEverything) {
  const test::OneThread alone;
  test::Reference kernel;
  const double reference = test::minSeconds({[&] { kernel.bake(); }})[0];
  for (const PaintQuantity quantity :
       {PaintQuantity::color, PaintQuantity::relief, quantityOf(MaterialChannel::stiffness)}) {
    const vtkNew<vtkRenderer> renderer, overlay;
    PaintLayer layer(*renderer, *overlay);
    Scene scene = paintedScene(512);
    layer.set(scene);
    layer.show(quantity);
    layer.setVisible(true);
    const double whole = milliseconds([&] { layer.prepare(); });
    double least = INFINITY;
    for (int dab = 0; dab < 8; ++dab) {
      scene = dabbed(scene);
      layer.set(scene);
      least = std::min(least, milliseconds([&] { layer.prepare(); }));
    }
    RecordProperty("whole_ms_" + std::to_string(static_cast<int>(quantity)), std::to_string(whole));
    RecordProperty("dab_ms_" + std::to_string(static_cast<int>(quantity)), std::to_string(least));
    EXPECT_LT(least, 0.2 * whole);
    EXPECT_TRUE(test::within("a dab", 1e-3 * least, reference, 3));
    EXPECT_LT(milliseconds([&] { layer.prepare(); }), 0.5 * whole); // no change to prepare
  }
}

TEST(PaintLayer, DrawsThePaintOfTheShownLayer) {
  const vtkNew<vtkRenderer> renderer, overlay;
  PaintLayer layer(*renderer, *overlay);
  Scene scene = paintedScene(128);
  scene.objects.push_back(objectOf(sheet(0.1, 0.1, 1)));
  layer.set(scene);
  EXPECT_FALSE(layer.draws(0));
  layer.show(quantityOf(MaterialChannel::stiffness));
  EXPECT_TRUE(layer.draws(0));
  EXPECT_FALSE(layer.draws(1));
  EXPECT_FALSE(layer.draws(2));
  EXPECT_FALSE(layer.has(quantityOf(MaterialChannel::damping)));
  layer.show(quantityOf(MaterialChannel::damping));
  EXPECT_FALSE(layer.draws(0));
  scene.objects[0].paint = nullptr;
  layer.set(scene);
  layer.show(PaintQuantity::color);
  EXPECT_FALSE(layer.draws(0));
  EXPECT_EQ(renderer->GetActors()->GetNumberOfItems(), 0); // no actor remains
}

TEST(PaintLayer, RangeFollowsThePaintUntilLocked) {
  const vtkNew<vtkRenderer> renderer, overlay;
  PaintLayer layer(*renderer, *overlay);
  const Scene scene = paintedScene(128);
  layer.set(scene);
  layer.show(quantityOf(MaterialChannel::stiffness));
  layer.setVisible(true);
  layer.prepare();
  const ValueRange found = layer.range(quantityOf(MaterialChannel::stiffness));
  EXPECT_LE(found.low, 330);
  EXPECT_GE(found.high, 870);
  EXPECT_GT(found.low, 150);
  ColorScale locked;
  locked.range = ValueRange{0, 100};
  layer.setScale(quantityOf(MaterialChannel::stiffness), locked);
  layer.prepare();
  EXPECT_EQ(layer.range(quantityOf(MaterialChannel::stiffness)), (ValueRange{0, 100}));
  EXPECT_EQ(layer.colors()->GetRange()[1], 100);
  // Half of the values lie beyond quartiles.
  layer.setScale(quantityOf(MaterialChannel::stiffness), parseColorScale("percentile=25"));
  layer.prepare();
  const ValueRange quartiles = layer.range(quantityOf(MaterialChannel::stiffness));
  EXPECT_GE(quartiles.low, found.low);
  EXPECT_LT(quartiles.high - quartiles.low, 0.9 * (found.high - found.low));
  layer.setScale(quantityOf(MaterialChannel::stiffness), {});
  layer.prepare();
  EXPECT_EQ(layer.range(quantityOf(MaterialChannel::stiffness)), found);
}

TEST(PaintedValue, ReportsTheRenderedValueAndItsShareOfPaint) { // K23
  Scene scene = paintedScene(64);
  scene.objects[0].world_from_object.translation() = Vec3(0.5, 0, 0);
  const MaterialMap& map = *scene.objects[0].paint->material;
  const Material base = baseMaterial(scene.haptics);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-0.034, 0.034);
  int painted = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 own(anywhere(random), anywhere(random), anywhere(random));
    const PaintedValue value =
        paintedValue(scene, MaterialChannel::stiffness, own + Vec3(0.5, 0, 0));
    ASSERT_NEAR(value.value, map.at(own, base).stiffness, 1e-6);
    if (std::abs(own.norm() - 0.03) < 0.002) {
      ASSERT_NEAR(value.weight, 1, 1e-9);
    }
    if (own.norm() < 0.025) {
      ASSERT_EQ(value.weight, 0);
    }
    if (value.weight > 0) ++painted;
  }
  EXPECT_GT(painted, 100);
}

TEST(PaintedValue, CountsAddedValuesAsPaintWithoutCoverage) {
  Scene scene;
  scene.objects.push_back(objectOf(sheet(1, 1, 1)));
  MaterialMap map(Vec3::Zero(), 1e-3);
  map.writable({0, 0, 0}, MaterialChannel::stiffness).value.fill(300);
  ObjectPaint paint;
  paint.material = std::make_shared<const MaterialMap>(std::move(map));
  scene.objects[0].paint = std::make_shared<const ObjectPaint>(std::move(paint));
  const PaintedValue value =
      paintedValue(scene, MaterialChannel::stiffness, Vec3::Constant(3.5e-3));
  EXPECT_NEAR(value.value, 800, 1e-9);
  EXPECT_GT(value.weight, 0.1);
}

TEST(SurfacePick, FaceOfTheJointMeshBelongsToOneObject) {
  Scene scene;
  scene.objects = {objectOf(sheet(1, 1, 1)), objectOf(sheet(1, 1, 3))};
  const auto second = objectPointOf(scene, {5, Vec3(0.2, 0.3, 0.5)});
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->object, 1U);
  EXPECT_EQ(second->point.face, 3);
  EXPECT_EQ(second->point.barycentric, Vec3(0.2, 0.3, 0.5));
  EXPECT_EQ(objectPointOf(scene, {1, Vec3::Zero()})->object, 0U);
  EXPECT_FALSE(objectPointOf(scene, {20, Vec3::Zero()}).has_value());
  EXPECT_FALSE(objectPointOf(scene, {-1, Vec3::Zero()}).has_value());
}

} // namespace
} // namespace patina
