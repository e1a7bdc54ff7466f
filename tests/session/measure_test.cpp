// Measurements between clicked points of a compiled scene, and tables of pins.
#include "session/open/measure.h"

#include <gtest/gtest.h>

#include "core/csv.h"
#include "geometry/atlas/texture_layout.h"
#include "geometry/mesh/shapes.h"
#include "session/compile/probe_table.h"
#include "support/painted_objects.h"

namespace patina {
namespace {

std::shared_ptr<const CompiledScene> compiledWith(TriangleMesh mesh) {
  Scene scene;
  scene.field.resolution = 60;
  scene.objects = {
      {"body", std::make_shared<const TriangleMesh>(std::move(mesh)), Pose::Identity()}};
  Progress progress;
  return compile(scene, progress);
}

TEST(Measure, FindsTheSideOfABoxStraightAndOverItsFaces) {
  const auto scene = compiledWith(box(Vec3::Constant(0.1)));
  const auto corner = [&](double x, double y, double z) {
    return measuredPointAt(*scene, 0.05 * Vec3(x, y, z));
  };
  ASSERT_GE(corner(1, 1, 1).surface.face, 0);
  const Measurement side = measureDistance(*scene, corner(-1, -1, 1), corner(1, -1, 1));
  EXPECT_NEAR(side.value, 0.1, 1e-9);
  EXPECT_EQ(side.words, "100.000 mm straight, 100.000 mm along the surface");
  const Measurement across = measureDistance(*scene, corner(-1, -1, -1), corner(1, 1, 1));
  EXPECT_EQ(across.words, "173.205 mm straight, 223.607 mm along the surface");
  const Measurement angle = measureAngle(corner(-1, 1, 1), corner(1, 1, 1), corner(1, -1, 1));
  EXPECT_EQ(angle.words, "90.000°");
  const Measurement flat = measureSphere(*scene, measuredPointAt(*scene, {0, 0, 0.05}), 0.01);
  EXPECT_TRUE(flat.failed);
}

TEST(Measure, FindsTheRadiusOfABall) {
  const auto scene = compiledWith(icosphere(0.03, 24));
  const Measurement sphere =
      measureSphere(*scene, measuredPointAt(*scene, {0, 0.018, 0.024}), 0.006);
  ASSERT_FALSE(sphere.failed) << sphere.words;
  EXPECT_NEAR(sphere.value, 0.03, 1e-3 * 0.03);
}

TEST(Measure, FindsTheAreaOfAPaintedDisc) {
  constexpr double kDisc = 0.011;
  SceneObject plate{"plate", std::make_shared<const TriangleMesh>(sheet(0.1, 0.1, 4)),
                    Pose::Identity()};
  ObjectPaint paint;
  paint.layout = generateAtlas(*plate.mesh, 1024);
  const double texel = 0.1 / 1024;
  paint.color = imageOf(*plate.mesh, *paint.layout.uvs, 1024, 4, [&](const Vec3& p, float* rgba) {
    const double off = (p - Vec3(0.01, 0.02, 0)).norm();
    const float cover = static_cast<float>(std::clamp(0.5 + (kDisc - off) / texel, 0.0, 1.0));
    for (int c = 0; c < 4; ++c) rgba[c] = cover;
  });
  plate.paint = std::make_shared<const ObjectPaint>(paint);
  Scene scene;
  scene.field.resolution = 60;
  scene.objects = {plate};
  Progress progress;
  const auto compiled = compile(scene, progress);
  const Measurement area = measurePaint(*compiled, measuredPointAt(*compiled, {0.01, 0.02, 0}));
  ASSERT_FALSE(area.failed) << area.words;
  EXPECT_NEAR(area.value, M_PI * kDisc * kDisc, 0.01 * M_PI * kDisc * kDisc) << area.words;
  EXPECT_TRUE(measurePaint(*compiled, measuredPointAt(*compiled, {-0.03, -0.03, 0})).failed);
}

TEST(PinTable, HasNamesAndTheValuesOfTheProbe) {
  auto made = *compiledWith(icosphere(0.03, 16));
  made.scene.pins = {{"A", Vec3(0, 0, 0.0305)}, {"rim", Vec3(0.03, 0, 0)}};
  const std::string table = pinTable(made);
  EXPECT_EQ(table.substr(0, 24), "pin,x [m],y [m],z [m],ph");
  EXPECT_EQ(pinLabel(made, made.scene.pins[0]).substr(0, 2), "A ");
  EXPECT_NE(table.find("\nA,0,0,0.0305,"), std::string::npos) << table;
  EXPECT_NE(table.find("\nrim,0.03,0,0,"), std::string::npos) << table;
}

} // namespace
} // namespace patina
