// Effects of a stroke on images and material (K18, K20, K22).
#include "authoring/brush/painter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "authoring/brush/surface_values.h"
#include "authoring/brush/volume_fill.h"
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

TEST(Painter, DabPaintsColorUnderTheBrushOnly) {
  const Scene scene = sceneOf(icosphere(kR, 12), 60, 256);
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::color, 0.02);
  brush.falloff = 50;
  brush.color = {0.2, 0.4, 0.8};
  PaintReport report;
  const Scene after = painted(surface, scene, strokeAt(brush, kTop), &report);
  EXPECT_EQ(report.dabs, 1u);
  EXPECT_GT(report.texels, 100u);
  const SurfaceValues at = valuesAt(*surface, after, kTop);
  EXPECT_NEAR(at.color[0], 0.2, 1e-6);
  EXPECT_NEAR(at.color[2], 0.8, 1e-6);
  EXPECT_NEAR(at.color[3], 1, 1e-6);
  EXPECT_EQ(valuesAt(*surface, after, -kTop).color[3], 0);
  EXPECT_EQ(valuesAt(*surface, after, Vec3(kR, 0, 0)).color[3], 0);
}

// No line appears along a chart's edge: at any point the paint equals the brush's weight.
TEST(Painter, AtlasSeamsAreInvisible) {
  const Scene scene = sceneOf(icosphere(kR, 12), 60, 512);
  const auto surface = surfaceOf(scene);
  ASSERT_TRUE(surface->objects[0].layout.generated);
  const TriangleMesh& mesh = *surface->mesh;
  const Vec3 tops[] = {kTop, Vec3(1, 1, 1).normalized() * kR, Vec3(-kR, 0, 0)};
  for (const Vec3& top : tops) {
    const Brush brush = brushOf(Tool::color, 0.03);
    const auto foot = VolumeFill(surface).foot(top);
    ASSERT_TRUE(foot);
    const Scene after = painted(surface, scene, strokeAt(brush, top));
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    double worst = 0;
    for (int k = 0; k < 30000; ++k) {
      SurfacePoint point{static_cast<std::int32_t>(random() % mesh.triangles.size()), {}};
      const double a = std::sqrt(unit(random)), b = unit(random);
      point.barycentric = Vec3(1 - a, a * (1 - b), a * b);
      const double distance = (position(mesh, point) - foot->point).norm();
      const double got = surfaceValues(after, 0, point).color[3];
      worst = std::max(worst, std::abs(got - brushWeight(brush, distance, brush.radius)));
    }
    // A texel is some 0.5 mm: a slope of 1 / 30 mm changes by less than 0.02 over it.
    EXPECT_LT(worst, 0.03) << top.transpose();
  }
}

// T-K17 on a surface: the coverage's integral over the plane.
TEST(Painter, CoverageOfAFlatFaceMatchesTheClosedForm) {
  const Scene scene = sceneOf(box(Vec3(0.1, 0.1, 0.02), 6), 60, 512);
  const auto surface = surfaceOf(scene);
  for (const double f : {1.0, 2.0, 8.0}) {
    Brush brush = brushOf(Tool::color, 0.02);
    brush.front_only = true;
    brush.falloff = f;
    const Scene after = painted(surface, scene, strokeAt(brush, Vec3(0.003, 0.002, 0.01)));
    // Points of the plane z = 0.01 on a lattice of their own.
    double sum = 0;
    constexpr int kAcross = 160;
    for (int j = 0; j < kAcross; ++j)
      for (int i = 0; i < kAcross; ++i) {
        const Vec3 p(0.003 + 0.025 * (2.0 * i / kAcross - 1),
                     0.002 + 0.025 * (2.0 * j / kAcross - 1), 0.01);
        sum += valuesAt(*surface, after, p).color[3];
      }
    const double area = sum * std::pow(0.05 / kAcross, 2);
    EXPECT_NEAR(area / (std::numbers::pi * 0.02 * 0.02), f / (f + 2), 0.02) << f;
  }
}

// T-K16c: texture coordinates stretched ten to one.
TEST(Painter, SpotIsRoundUnderStretchedCoordinates) {
  TriangleMesh mesh = sheet(0.1, 0.1, 10);
  for (const Triangle& t : mesh.triangles) {
    auto& uv = mesh.corner_uvs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.positions[static_cast<std::size_t>(t[k])];
      uv[k] = Vec2(p.x() / 0.1 + 0.5, 0.1 * (p.y() / 0.1 + 0.5));
    }
  }
  const Scene scene = sceneOf(std::move(mesh), 60, 512);
  const auto surface = surfaceOf(scene);
  ASSERT_FALSE(surface->objects[0].layout.generated);
  Brush brush = brushOf(Tool::color, 0.03);
  brush.falloff = 8;
  const Scene after = painted(surface, scene, strokeAt(brush, Vec3(0.001, 0.003, 0)));
  double sum = 0;
  Vec2 mean(0, 0), square(0, 0);
  forTexels(*surface, 0, *after.objects[0].paint->color, [&](const Vec3& p, int i, int j) {
    const auto w = static_cast<double>(after.objects[0].paint->color->at(i, j, 3));
    sum += w;
    mean += w * p.head<2>();
    square += w * p.head<2>().cwiseProduct(p.head<2>());
  });
  mean /= sum;
  const Vec2 variance = square / sum - mean.cwiseProduct(mean);
  EXPECT_NEAR(std::sqrt(variance.y() / variance.x()), 1, 2 * 0.002 / 0.03);
  EXPECT_NEAR(mean.x(), 0.001, 0.002);
  EXPECT_NEAR(mean.y(), 0.003, 0.002);
}

// T-K18: repeated dabs reduce the remainder by the same factor each; rounding does not stop it.
TEST(Painter, BuildUpAtRestFollowsItsPowerLaw) {
  const Scene scene = sceneOf(icosphere(kR, 12));
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::color, 0.02);
  brush.mode = StrokeMode::build_up;
  brush.color = {0.8, 0.4, 0};
  Painter painter(surface, scene);
  painter.begin(brush);
  const auto foot = VolumeFill(surface).foot(kTop);
  int n = 0;
  for (const int until : {1, 5, 100, 2000}) {
    for (; n < until; ++n) painter.dab({n / 60.0, kTop, 0});
    const TiledImage& image = *painter.paint()[0]->color;
    forTexels(*surface, 0, image, [&](const Vec3& p, int i, int j) {
      const double w = brushWeight(brush, (p - foot->point).norm(), brush.radius);
      const double covered = 1 - std::pow(1 - w, n);
      EXPECT_NEAR(static_cast<double>(image.at(i, j, 3)), covered, 2e-5) << n << " " << w;
      EXPECT_NEAR(static_cast<double>(image.at(i, j, 0)), 0.8 * covered, 2e-5);
    });
  }
}

TEST(Painter, MaxModeIsTheSameAtThirtyAndAtSixtyHertz) {
  const auto greatest_difference = [](TriangleMesh mesh, const std::function<Vec3(double)>& path) {
    const Scene scene = sceneOf(std::move(mesh));
    const auto surface = surfaceOf(scene);
    std::shared_ptr<const ObjectPaint> paint[2];
    for (int rate = 0; rate < 2; ++rate) {
      Stroke stroke{brushOf(Tool::relief, 0.01, 1e-3), {}};
      const int n = rate ? 60 : 30;
      for (int k = 0; k <= n; ++k)
        stroke.samples.push_back({static_cast<double>(k) / n, path(static_cast<double>(k) / n), 0});
      paint[rate] = painted(surface, scene, stroke).objects[0].paint;
    }
    double worst = 0;
    forTexels(*surface, 0, *paint[0]->relief, [&](const Vec3&, int i, int j) {
      worst = std::max(worst, static_cast<double>(std::abs(paint[0]->relief->at(i, j, 0) -
                                                           paint[1]->relief->at(i, j, 0))));
    });
    return worst;
  };
  EXPECT_LT(greatest_difference(box(Vec3(0.1, 0.1, 0.02), 6),
                                [](double t) { return Vec3(-0.03 + 0.06 * t, 0.02 * t, 0.01); }),
            1e-6);
  // The chords of the two rates differ slightly on a sphere.
  EXPECT_LT(greatest_difference(
                icosphere(kR, 12),
                [](double t) -> Vec3 { return kR * Vec3(std::sin(2 * t), 0, std::cos(2 * t)); }),
            3e-3);
}

// A stroke is as high along its middle as a dab: there are no tangible ripples.
TEST(Painter, StrokeHasNoRipples) {
  const Scene scene = sceneOf(box(Vec3(0.1, 0.1, 0.02), 6), 60, 256);
  const auto surface = surfaceOf(scene);
  const Brush brush = brushOf(Tool::color, 0.012);
  const Scene after =
      painted(surface, scene, strokeAlong(brush, Vec3(-0.03, 0, 0.01), Vec3(0.03, 0, 0.01), 11));
  const TiledImage& image = *after.objects[0].paint->color;
  int seen = 0;
  forTexels(*surface, 0, image, [&](const Vec3& p, int i, int j) {
    if (std::abs(p.x()) > 0.03 || std::abs(p.z() - 0.01) > 1e-9) return;
    ++seen;
    EXPECT_NEAR(static_cast<double>(image.at(i, j, 3)),
                brushWeight(brush, std::abs(p.y()), brush.radius), 1e-6);
  });
  EXPECT_GT(seen, 500);
}

TEST(Painter, ReplayIsBitwiseEqualForAnyNumberOfSnapshots) {
  const Scene scene = sceneOf(torus(0.04, 0.015, 60, 30));
  const auto surface = surfaceOf(scene);
  for (const StrokeMode mode : {StrokeMode::max, StrokeMode::build_up, StrokeMode::smooth}) {
    Brush brush = brushOf(Tool::relief, 0.012, 1e-3);
    const Scene ground = painted(surface, scene, strokeAt(brush, Vec3(0.055, 0, 0)));
    brush.mode = mode;
    brush.radius_per_force = 0.001;
    Stroke stroke = strokeAlong(brush, Vec3(0.055, -0.01, 0), Vec3(0.04, 0.01, 0.015), 20);
    for (std::size_t k = 0; k < stroke.samples.size(); ++k)
      stroke.samples[k].force = static_cast<double>(k % 5);
    const Scene once = painted(surface, ground, stroke);
    Painter painter(surface, ground);
    painter.begin(brush);
    std::vector<std::shared_ptr<const ObjectPaint>> versions;
    std::vector<TiledImage> copies;
    for (const StrokeSample& sample : stroke.samples) {
      painter.dab(sample);
      versions.push_back(painter.paint()[0]);
      copies.push_back(*versions.back()->relief);
    }
    painter.end();
    EXPECT_TRUE(same(*once.objects[0].paint, *painter.paint()[0]));
    EXPECT_FALSE(same(*once.objects[0].paint, *ground.objects[0].paint));
    for (std::size_t k = 0; k < versions.size(); ++k)
      EXPECT_TRUE(same(*versions[k]->relief, copies[k]));
  }
}

TEST(Painter, AddsOncePerStroke) {
  const Scene scene = sceneOf(box(Vec3(0.1, 0.1, 0.02), 6));
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::relief, 0.02, 1e-3);
  brush.mode = StrokeMode::add;
  Scene now = scene;
  for (int k = 1; k <= 3; ++k) {
    now = painted(surface, now, strokeAlong(brush, Vec3(-0.02, 0, 0.01), Vec3(0.02, 0, 0.01), 30));
    EXPECT_NEAR(valuesAt(*surface, now, Vec3(0, 0, 0.01)).height, 1e-3 * k, 4e-5 * k);
  }
  brush.value = -3e-3;
  now = painted(surface, now, strokeAlong(brush, Vec3(-0.02, 0, 0.01), Vec3(0.02, 0, 0.01), 30));
  EXPECT_NEAR(valuesAt(*surface, now, Vec3(0, 0, 0.01)).height, 0, 1e-9);
}

// A step in height across the middle of an atlas-ed sphere, smoothed: no cliff is left anywhere
// under the brush, wherever the charts end.
TEST(Painter, SmoothingCrossesSeams) {
  const Scene scene = sceneOf(icosphere(kR, 12), 60, 256);
  const auto surface = surfaceOf(scene);
  const Vec3 top = Vec3(1, 1, 1).normalized() * kR;
  auto image = std::make_shared<TiledImage>(256, 256, 1);
  forTexels(*surface, 0, *image, [&](const Vec3& p, int i, int j) {
    image->writable(image->tileOf(i, j))[image->offsetOf(i, j)] = p.x() > p.y() ? 1.0f : 0.0f;
  });
  Scene ground = scene;
  auto paint = std::make_shared<ObjectPaint>();
  paint->layout = surface->objects[0].layout;
  paint->relief = image;
  ground.objects[0].paint = paint;
  Brush brush = brushOf(Tool::relief, 0.03);
  brush.mode = StrokeMode::smooth;
  brush.falloff = 20;
  Stroke stroke{brush, {}};
  for (int k = 0; k < 60; ++k) stroke.samples.push_back({k / 60.0, top, 0});
  const Scene after = painted(surface, ground, stroke);
  double steepest = 0; // a step of 0.6 mm across the step's line
  for (int k = -20; k <= 20; ++k) {
    const Vec3 on =
        kR * (top.normalized() + 0.02 * k * Vec3(-0.5, -0.5, 1).normalized()).normalized();
    const Vec3 aside = 3e-4 * Vec3(1, -1, 0).normalized();
    const double step =
        valuesAt(*surface, after, on + aside).height - valuesAt(*surface, after, on - aside).height;
    steepest = std::max(steepest, std::abs(step));
  }
  EXPECT_LT(steepest, 0.2e-3); // for a relief of 1 mm
  EXPECT_GT(steepest, 0.005e-3);
}

TEST(Painter, SmoothingLeavesTheFarSideOfAThinWall) {
  const Scene scene = sceneOf(box(Vec3(0.1, 0.1, 0.0005), 4)); // thinner than a texel is wide
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::relief, 0.03, 1e-3);
  brush.falloff = 1000;
  brush.front_only = true;
  const Vec3 p(0, 0, 0.00025);
  const Scene ground = painted(surface, scene, strokeAt(brush, p));
  brush.front_only = false;
  brush.mode = StrokeMode::smooth;
  brush.radius = 0.01;
  const Scene after = painted(surface, ground, strokeAlong(brush, p, p + Vec3(0.001, 0, 0), 50));
  EXPECT_NEAR(valuesAt(*surface, after, p).height, 1e-3, 1e-9);
  EXPECT_EQ(valuesAt(*surface, after, -p).height, 0);
}

TEST(Painter, SoftEraserReachesZero) {
  const Scene scene = sceneOf(icosphere(kR, 12));
  const auto surface = surfaceOf(scene);
  const Scene ground = painted(surface, scene, strokeAt(brushOf(Tool::color, 0.01), kTop));
  Brush eraser = brushOf(Tool::erase, 0.02);
  eraser.mode = StrokeMode::build_up;
  Stroke stroke{eraser, {}};
  for (int k = 0; k < 60; ++k) stroke.samples.push_back({k / 60.0, kTop, 0});
  EXPECT_EQ(painted(surface, ground, stroke).objects[0].paint, nullptr);
}

TEST(Painter, EraserLeavesNothingBehind) {
  const Scene scene = sceneOf(icosphere(kR, 12));
  const auto surface = surfaceOf(scene);
  Scene now = painted(surface, scene, strokeAt(brushOf(Tool::color, 0.02), kTop));
  now = painted(surface, now, strokeAt(brushOf(Tool::relief, 0.02, 1e-3), kTop));
  now = painted(surface, now,
                strokeAt(brushOf(Tool::material(MaterialChannel::damping), 0.02, 3), kTop));
  const Scene all = painted(
      surface, now, strokeAt(brushOf(Tool::material(MaterialChannel::stiffness), 0.02, 900), kTop));
  Brush eraser = brushOf(Tool::erase, 0.03);
  eraser.falloff = 1000;
  eraser.erases = "damping";
  const Scene one = painted(surface, all, strokeAt(eraser, kTop));
  EXPECT_TRUE(same(*one.objects[0].paint->color, *all.objects[0].paint->color));
  EXPECT_FALSE(one.objects[0].paint->material->has(MaterialChannel::damping));
  EXPECT_TRUE(one.objects[0].paint->material->has(MaterialChannel::stiffness));
  eraser.erases.clear();
  EXPECT_EQ(painted(surface, all, strokeAt(eraser, kTop)).objects[0].paint, nullptr);
  eraser.falloff = 1; // soft
  const Scene soft = painted(surface, all, strokeAt(eraser, kTop));
  const double before = valuesAt(*surface, all, Vec3(0.01, 0, 0.049)).color[3];
  const double after = valuesAt(*surface, soft, Vec3(0.01, 0, 0.049)).color[3];
  EXPECT_NEAR(after / before, 1.0 / 3, 0.03);
}

TEST(Painter, SamePaintAgainAndTheEraserOnNothingTakeNoMemory) {
  const Scene scene = sceneOf(icosphere(kR, 12));
  const auto surface = surfaceOf(scene);
  EXPECT_EQ(painted(surface, scene, strokeAt(brushOf(Tool::erase, 0.02), kTop)).objects[0].paint,
            nullptr);
  EXPECT_EQ(
      painted(surface, scene, strokeAt(brushOf(Tool::relief, 0.02, 0), kTop)).objects[0].paint,
      nullptr);
  Brush hard = brushOf(Tool::color, 0.02);
  hard.falloff = 1000;
  const Scene once = painted(surface, scene, strokeAt(hard, kTop));
  hard.radius = 0.015;
  const Scene twice = painted(surface, once, strokeAt(hard, kTop));
  EXPECT_EQ(once.objects[0].paint, twice.objects[0].paint);
}

TEST(Painter, SymmetryPaintsTheMirrorImageInTheObjectsOwnFrame) {
  Pose pose(Eigen::Translation3d(0.3, -0.2, 0.1) *
            Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  const Scene scene = sceneOf({objectOf("tilted", torus(0.04, 0.015, 60, 30), pose)});
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::material(MaterialChannel::stiffness), 0.012, 900);
  brush.symmetry = Symmetry::y;
  PaintReport report;
  const Scene after =
      painted(surface, scene, strokeAt(brush, pose * Vec3(0.03, 0.0264, 0.015)), &report);
  EXPECT_EQ(report.dabs, 2u);
  for (const double x : {0.025, 0.03, 0.034})
    for (const double y : {0.022, 0.026, 0.03}) {
      const auto stiffness = [&](double side) {
        return valuesAt(*surface, after, pose * Vec3(x, side * y, 0.015)).material.stiffness;
      };
      EXPECT_NEAR(stiffness(1), stiffness(-1), 8); // for 400 N/m: the nodes are not symmetric
      EXPECT_GT(stiffness(1), 520);
    }
}

TEST(Painter, ChangesListThePartsToRefresh) {
  const Scene scene = sceneOf(icosphere(kR, 12));
  const auto surface = surfaceOf(scene);
  Painter painter(surface, scene);
  EXPECT_TRUE(painter.takeChanges().empty());
  painter.begin(brushOf(Tool::color, 0.01));
  painter.dab({0, kTop, 0});
  const auto changes = painter.takeChanges();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_TRUE(changes[0].images);
  EXPECT_TRUE(changes[0].material_blocks.empty());
  EXPECT_TRUE(painter.takeChanges().empty());
}

} // namespace
} // namespace patina
