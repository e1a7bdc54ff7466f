// Picking and painting far from the origin give the same results as at the origin.
#include <random>

#include <gtest/gtest.h>

#include "authoring/paint_fixture.h"
#include "scene/surface_pick.h"

namespace patina {
namespace {

using test::brushOf;
using test::sceneOf;
using test::strokeAlong;
using test::surfaceOf;

TriangleMesh shifted(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.positions) p += by;
  return mesh;
}

TEST(FarPaint, IsTheSameAsAtTheOrigin) {
  const TriangleMesh shapes[] = {box(Vec3::Constant(0.05), 1), icosphere(0.03, 12),
                                 torus(0.03, 0.012, 40, 20)};
  const Vec3 places[] = {Vec3(4.5e6, 5.2e6, 300), Vec3(450000, 5400000, 120), Vec3(-1e7, 0, 1e5),
                         Vec3(1e5, -1e5, 1e5)};
  Brush brush = brushOf(Tool::color, 0.016);
  brush.extra_layers.resize(2);
  brush.extra_layers[0].tool = Tool::relief;
  brush.extra_layers[0].value = 5e-4;
  brush.extra_layers[1].tool = Tool::material(MaterialChannel::stiffness);
  brush.extra_layers[1].value = 900;
  for (const TriangleMesh& mesh : shapes) {
    const Scene near = sceneOf(mesh, 60, 256);
    const auto near_surface = surfaceOf(near);
    const Vec3 from(-0.01, 0.024, 0.025), to(0.012, 0.02, 0.025);
    PaintReport near_report;
    const Scene near_after =
        painted(near_surface, near, strokeAlong(brush, from, to, 20), &near_report);
    ASSERT_GT(near_report.texels, 1000u);
    for (const Vec3& at : places) {
      const Scene far = sceneOf(shifted(mesh, at), 60, 256);
      const auto far_surface = surfaceOf(far);
      PaintReport report;
      const Scene after =
          painted(far_surface, far, strokeAlong(brush, from + at, to + at, 20), &report);
      EXPECT_EQ(report.dabs, near_report.dabs);
      EXPECT_NEAR(static_cast<double>(report.texels), static_cast<double>(near_report.texels),
                  0.03 * static_cast<double>(near_report.texels));
      std::mt19937 random(5);
      std::uniform_real_distribution<double> unit(0, 1), side(-1, 1);
      double color = 0, height = 0, stiffness = 0, pick = 0;
      for (int k = 0; k < 2000; ++k) {
        SurfacePoint point{static_cast<std::int32_t>(random() % mesh.triangles.size()), {}};
        const double a = std::sqrt(unit(random)), b = unit(random);
        point.barycentric = Vec3(1 - a, a * (1 - b), a * b);
        const SurfaceValues here = surfaceValues(near_after, 0, point);
        const SurfaceValues there = surfaceValues(after, 0, point);
        color = std::max(color, std::abs(here.color[3] - there.color[3]));
        height = std::max(height, std::abs(here.height - there.height));
        stiffness =
            std::max(stiffness, std::abs(here.material.stiffness - there.material.stiffness));
        // A ray from outside towards a point inside.
        const Vec3 eye = 0.2 * Vec3(side(random), side(random), side(random)).normalized();
        const Vec3 way = (0.01 * Vec3(side(random), side(random), side(random)) - eye).normalized();
        const auto hit = firstSurfaceAlong(*near_surface->field, eye, way);
        const auto far_hit = firstSurfaceAlong(*far_surface->field, eye + at, way);
        if (!hit || !far_hit) continue; // just beyond an edge
        pick = std::max(pick, (*hit + at - *far_hit).norm());
      }
      // The path of the stroke is rounded to some nanometres, and the painted grid may be offset
      // within a voxel.
      EXPECT_LT(color, 0.02) << at.transpose();
      EXPECT_LT(height, 2e-5) << at.transpose();
      EXPECT_LT(stiffness, 20) << at.transpose();
      EXPECT_LT(pick, 2e-5) << at.transpose();
    }
  }
}

} // namespace
} // namespace patina
