// Several layers in one stroke, and the start point of a dab (K15, K17).
#include <gtest/gtest.h>

#include "authoring/paint_fixture.h"

namespace patina {
namespace {

using test::brushOf;
using test::forTexels;
using test::kR;
using test::kTop;
using test::sceneOf;
using test::strokeAlong;
using test::strokeAt;
using test::surfaceOf;

// The published brush: the effect of each layer alone, in one stroke.
TEST(Painter, LayersOfOneStrokeEqualOneStrokeEach) {
  const Scene scene = sceneOf(icosphere(kR, 12), 60, 256);
  const auto surface = surfaceOf(scene);
  for (const StrokeMode mode : {StrokeMode::max, StrokeMode::build_up}) {
    Brush brush = brushOf(Tool::material(MaterialChannel::stiffness), 0.012, 900);
    brush.mode = mode;
    brush.color = {0.3, 0.1, 0.9};
    Scene apart = scene;
    for (const auto& [tool, value] : {std::pair{Tool::material(MaterialChannel::stiffness), 900.0},
                                      {Tool::color, 0.0},
                                      {Tool::relief, 3e-4},
                                      {Tool::material(MaterialChannel::static_friction), 0.7}}) {
      BrushLayer layer = brush;
      layer.tool = tool;
      layer.value = value;
      if (tool != brush.tool) brush.extra_layers.push_back(layer);
      Brush one = brush;
      one.extra_layers.clear();
      static_cast<BrushLayer&>(one) = layer;
      apart = painted(surface, apart, strokeAlong(one, kTop, Vec3(kR, 0, 0), 7));
    }
    PaintReport report;
    const Scene after =
        painted(surface, scene, strokeAlong(brush, kTop, Vec3(kR, 0, 0), 7), &report);
    EXPECT_GT(report.texels, 0U);
    EXPECT_GT(report.nodes, 0U);
    EXPECT_TRUE(same(*after.objects[0].paint, *apart.objects[0].paint));
    EXPECT_TRUE(after.objects[0].paint->material->has(MaterialChannel::static_friction));
  }
}

// On a sheet thinner than the field resolves, the nearest point may lie on the far side.
TEST(Painter, SeedOnTheSegmentPaintsTheSideOfTheTip) {
  const double thick = 2e-4;
  const Scene scene = sceneOf(box(Vec3(0.05, 0.05, thick), 4), 60, 256);
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::color, 0.004);
  brush.front_only = true;
  Stroke stroke = strokeAt(brush, Vec3(0.003, 0.002, -0.4 * thick)); // nearer to the lower side
  stroke.samples[0].tip = Vec3(0.003, 0.002, 3 * thick); // held at the upper one, above it
  const auto sides = [&](const Scene& after) {
    std::pair<int, int> count; // upper, lower
    const TiledImage& image = *after.objects[0].paint->color;
    forTexels(*surface, 0, image, [&](const Vec3& p, int i, int j) {
      if (image.at(i, j, 3) > 0) ++(p.z() > 0 ? count.first : count.second);
    });
    return count;
  };
  const auto nearest = sides(painted(surface, scene, stroke));
  EXPECT_EQ(nearest.first, 0);
  EXPECT_GT(nearest.second, 100);
  stroke.brush.anchor = DabAnchor::segment;
  const auto segmentHit = sides(painted(surface, scene, stroke));
  EXPECT_GT(segmentHit.first, 100);
  EXPECT_EQ(segmentHit.second, 0);
  stroke.samples[0].tip.reset(); // no segment without a tip
  EXPECT_EQ(sides(painted(surface, scene, stroke)), nearest);
}

} // namespace
} // namespace patina
