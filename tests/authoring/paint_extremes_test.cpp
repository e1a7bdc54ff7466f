// Extreme cases of painting.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "authoring/brush/surface_values.h"
#include "authoring/paint_fixture.h"
#include "core/error.h"

namespace patina {
namespace {

using test::brushOf;
using test::forTexels;
using test::kR;
using test::kTop;
using test::objectOf;
using test::sceneOf;
using test::strokeAlong;
using test::strokeAt;
using test::surfaceOf;
using test::valuesAt;

TEST(PaintExtremes, ZeroRadiusPaintsNothing) {
  const Scene scene = sceneOf(icosphere(kR, 12));
  const auto surface = surfaceOf(scene);
  for (const Tool tool : {Tool::color, Tool::relief, Tool::material(MaterialChannel::stiffness)}) {
    PaintReport report;
    const Scene after = painted(
        surface, scene, strokeAlong(brushOf(tool, 0, 0.1), kTop, Vec3(kR, 0, 0), 5), &report);
    EXPECT_EQ(after.objects[0].paint, nullptr);
    EXPECT_EQ(report.dabs, 0u);
    EXPECT_EQ(report.missed, 6u);
  }
}

TEST(PaintExtremes, BrushBelowAVoxelPaintsItsTexels) {
  const Scene scene = sceneOf(icosphere(kR, 12), 60, 1024);
  const auto surface = surfaceOf(scene);
  PaintReport report;
  const double h = surface->field->grid.voxel;
  (void)painted(surface, scene, strokeAt(brushOf(Tool::color, 0.4 * h), kTop), &report);
  EXPECT_GT(report.texels, 5u);
  EXPECT_EQ(report.missed, 0u);
}

TEST(PaintExtremes, BrushBeyondTheObjectPaintsAllOfIt) {
  const Scene scene = sceneOf(torus(0.04, 0.015, 60, 30));
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::color, 0.5);
  brush.falloff = 1000;
  PaintReport report;
  const Scene after = painted(surface, scene, strokeAt(brush, Vec3(0.055, 0, 0)), &report);
  EXPECT_EQ(report.faces, surface->mesh->triangles.size());
  const TiledImage& image = *after.objects[0].paint->color;
  forTexels(*surface, 0, image,
            [&](const Vec3&, int i, int j) { ASSERT_EQ(image.at(i, j, 3), 1.0f); });
  brush.tool = Tool::material(MaterialChannel::stiffness);
  brush.value = 800;
  const Scene hard = painted(surface, scene, strokeAt(brush, Vec3(0.055, 0, 0)));
  EXPECT_NEAR(valuesAt(*surface, hard, Vec3(-0.055, 0, 0)).material.stiffness, 800, 1e-9);
  // The map has no more than the blocks near the surface.
  EXPECT_LE(hard.objects[0].paint->material->blocks().size(), surface->field->blockCount());
}

TEST(PaintExtremes, DegenerateCoordinatesDoNoHarm) {
  TriangleMesh mesh = sheet(0.1, 0.1, 10);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    auto& uv = mesh.corner_uvs.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corner(f, k);
      uv[static_cast<std::size_t>(k)] = Vec2(p.x() / 0.1 + 0.5, p.y() / 0.1 + 0.5);
    }
    if (f % 3 == 0) uv = {Vec2(0.5, 0.5), Vec2(0.5, 0.5), Vec2(0.5, 0.5)}; // a point
    if (f % 7 == 0) uv[2] = 0.5 * (uv[0] + uv[1]);                         // a line
  }
  const Scene scene = sceneOf(std::move(mesh));
  const auto surface = surfaceOf(scene);
  for (const StrokeMode mode : {StrokeMode::max, StrokeMode::smooth}) {
    Brush brush = brushOf(Tool::relief, 0.02, 1e-3);
    const Scene ground = painted(surface, scene, strokeAt(brush, Vec3(0, 0, 0)));
    brush.mode = mode;
    PaintReport report;
    const Scene after = painted(
        surface, ground, strokeAlong(brush, Vec3(-0.04, 0, 0), Vec3(0.04, 0, 0), 9), &report);
    EXPECT_GT(report.texels, 100u);
    forTexels(*surface, 0, *after.objects[0].paint->relief, [&](const Vec3&, int i, int j) {
      const float g = after.objects[0].paint->relief->at(i, j, 0);
      ASSERT_TRUE(g >= 0 && g <= 1) << g;
    });
  }
}

TEST(PaintExtremes, StrokeContinuesFromOneObjectToAnother) {
  const Pose beside(Eigen::Translation3d(0.05, 0, 0));
  const Scene scene = sceneOf({objectOf("a", box(Vec3(0.048, 0.04, 0.01), 6)),
                               objectOf("b", box(Vec3(0.048, 0.04, 0.01), 6), beside)});
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::color, 0.006);
  PaintReport report;
  Scene after = painted(
      surface, scene, strokeAlong(brush, Vec3(-0.01, 0, 0.005), Vec3(0.06, 0, 0.005), 15), &report);
  EXPECT_EQ(report.missed, 0u);
  for (double x = -0.01; x <= 0.06; x += 1e-3) {
    const std::size_t object = x > 0.025 ? 1 : 0;
    if (std::abs(x - 0.025) < 0.0015) continue; // the gap
    EXPECT_NEAR(valuesAt(*surface, after, Vec3(x, 0, 0.005), object).color[3], 1, 0.12) << x;
  }
  brush = brushOf(Tool::material(MaterialChannel::dynamic_friction), 0.01, 0.7);
  after = painted(surface, scene, strokeAt(brush, Vec3(0.022, 0, 0.005)));
  ASSERT_TRUE(after.objects[0].paint && after.objects[1].paint);
  EXPECT_GT(valuesAt(*surface, after, Vec3(0.028, 0, 0.005), 1).material.dynamic_friction, 0.1);
}

TEST(PaintExtremes, ThinWallIsPaintedOnBothSidesOrOnTheFrontAlone) {
  const Scene scene = sceneOf(box(Vec3(0.1, 0.1, 0.002), 10));
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::color, 0.01);
  const Vec3 p(0, 0, 0.001);
  const Scene both = painted(surface, scene, strokeAt(brush, p));
  EXPECT_NEAR(valuesAt(*surface, both, -p).color[3], 0.8, 0.03);
  brush.front_only = true;
  const Scene front = painted(surface, scene, strokeAt(brush, p));
  EXPECT_GT(valuesAt(*surface, front, p).color[3], 0.9);
  EXPECT_EQ(valuesAt(*surface, front, -p).color[3], 0);
}

TEST(PaintExtremes, NonFiniteSamplesAreRejectedInFilesAndIgnoredLive) {
  const Scene scene = sceneOf(icosphere(kR, 12));
  const auto surface = surfaceOf(scene);
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const Brush brush = brushOf(Tool::color, 0.01);
  const Stroke good = strokeAlong(brush, kTop, Vec3(kR, 0, 0), 4);
  Stroke bad = good;
  bad.samples[2].position.x() = nan;
  EXPECT_THROW((void)painted(surface, scene, bad), Error);
  bad = good;
  bad.samples[2].force = infinity;
  EXPECT_THROW((void)painted(surface, scene, bad), Error);

  Painter painter(surface, scene);
  painter.begin(brush);
  for (const StrokeSample& sample : good.samples) {
    painter.dab(sample);
    for (const double x : {nan, infinity, -infinity, 1e300}) {
      EXPECT_EQ(painter.dab({sample.t, Vec3(0, x, 0), 0}).missed, 1u);
      if (!std::isfinite(x)) {
        EXPECT_EQ(painter.dab({sample.t, kTop, std::abs(x)}).missed, 1u);
      }
    }
  }
  painter.end();
  EXPECT_TRUE(same(*painter.paint()[0], *painted(surface, scene, good).objects[0].paint));
}

TEST(PaintExtremes, ForceSpikesStayWithinTheLargestRadius) {
  const Scene scene = sceneOf(icosphere(kR, 12));
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::color, 0.005);
  brush.radius_per_force = 0.001;
  brush.max_radius = 0.01;
  Stroke stroke{brush, {{0, kTop, 1}, {0.001, kTop, 1e6}, {0.5, kTop, 1e6}}};
  const Scene after = painted(surface, scene, stroke);
  const TiledImage& image = *after.objects[0].paint->color;
  forTexels(*surface, 0, image, [&](const Vec3& p, int i, int j) {
    if (image.at(i, j, 3) > 0) {
      EXPECT_LE((p - kTop).norm(), 0.0101);
    }
  });
}

TEST(PaintExtremes, MisuseIsRefused) {
  const Scene scene = sceneOf(icosphere(kR, 6));
  const auto bare = surfaceOf(scene, false);
  Painter painter(bare, scene);
  EXPECT_THROW(painter.dab({}), std::invalid_argument);
  EXPECT_THROW(painter.begin(brushOf(Tool::color, 0.01)), std::invalid_argument);
  EXPECT_NO_THROW(painter.begin(brushOf(Tool::erase, 0.01)));
  EXPECT_THROW(painter.begin(brushOf(Tool::material(MaterialChannel::stiffness), -1, 500)), Error);
  EXPECT_THROW(Painter(bare, sceneOf(icosphere(kR, 7))), std::invalid_argument);
  Scene flat = scene;
  flat.relief.height = 0;
  Painter none(bare, flat);
  EXPECT_THROW(none.begin(brushOf(Tool::relief, 0.01, 1e-3)), Error);
}

// Ten minutes at 60 Hz over the whole object: images and maps grow no larger than the object, and
// the first version is unchanged.
TEST(PaintExtremes, TenMinutesOfPaintingAreBounded) {
  const Scene scene = sceneOf(icosphere(kR, 5), 40, 64);
  const auto surface = surfaceOf(scene);
  Painter painter(surface, scene);
  constexpr int kDabs = 600 * 60, kStroke = 120;
  const std::array<Tool, 4> tools{Tool::color, Tool::relief,
                                  Tool::material(MaterialChannel::stiffness), Tool::erase};
  std::shared_ptr<const ObjectPaint> first;
  ObjectPaint copy;
  std::size_t most = 0;
  for (int k = 0; k < kDabs; ++k) {
    if (k % kStroke == 0) {
      painter.end();
      if (k == 3 * kStroke) first = painter.paint()[0];
      if (k == 3 * kStroke)
        copy = {first->layout, std::make_shared<TiledImage>(*first->color),
                std::make_shared<TiledImage>(*first->relief),
                std::make_shared<MaterialMap>(*first->material)};
      Brush brush = brushOf(tools[static_cast<std::size_t>(k / kStroke % 4)], 0.01, 600);
      if (brush.tool == Tool::relief) brush.value = 1e-3;
      brush.mode = k / kStroke % 3 ? StrokeMode::max : StrokeMode::build_up;
      painter.begin(brush);
    }
    const double a = 0.013 * k, b = 0.0017 * k;
    painter.dab({k / 60.0,
                 kR * Vec3(std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b)), 1});
    if (k % 10 == 0 && painter.paint()[0]) most = std::max(most, bytes(*painter.paint()[0]));
  }
  painter.end();
  // 5 channels of 64 x 64 texels, and a layer for every block of the field.
  const std::size_t bound = 5 * 64 * 64 * sizeof(float) +
                            surface->field->blockCount() * (sizeof(MaterialLayer) + 200) + 8192;
  EXPECT_LE(most, bound);
  EXPECT_GT(most, bound / 8);
  EXPECT_TRUE(same(*first, copy));
}

} // namespace
} // namespace patina
