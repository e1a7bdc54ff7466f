// Meshes whose coordinates or indices once left parts of them without paint.
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "authoring/images/apply_image.h"
#include "authoring/paint_fixture.h"

namespace patina {
namespace {

using test::brushOf;
using test::sceneOf;
using test::strokeAt;
using test::surfaceOf;
using test::valuesAt;

// Projects each face along its dominant axis over the mesh's box: all sides of a box cover the
// whole square.
TriangleMesh boxMapped(TriangleMesh mesh, double times = 1) {
  const Box3 box = bounds(mesh);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    int axis = 0;
    faceNormal(mesh, f).cwiseAbs().maxCoeff(&axis);
    auto& uv = mesh.corner_uvs.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const Vec3 at = (mesh.corner(f, k) - box.min()).cwiseQuotient(box.sizes());
      uv[static_cast<std::size_t>(k)] = times * Vec2(at[(axis + 1) % 3], at[(axis + 2) % 3]);
    }
  }
  return mesh;
}

// All faces on one triangle of the image.
TriangleMesh onOneTriangle(TriangleMesh mesh) {
  mesh.corner_uvs.assign(mesh.triangles.size(), {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)});
  return mesh;
}

// The half with x < 0 mirrored onto the other.
TriangleMesh mirrored(TriangleMesh mesh) {
  const Box3 box = bounds(mesh);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    auto& uv = mesh.corner_uvs.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const Vec3 at = (mesh.corner(f, k) - box.center()).cwiseQuotient(box.sizes());
      uv[static_cast<std::size_t>(k)] = Vec2(std::abs(at[0]) * 2, at[1] / 2 + 0.5);
    }
  }
  return mesh;
}

TriangleMesh twice(const TriangleMesh& mesh, bool other_way) {
  TriangleMesh copy = mesh;
  for (std::size_t f = 0; f < copy.triangles.size() && other_way; ++f) {
    std::swap(copy.triangles[f][1], copy.triangles[f][2]);
    if (!copy.corner_uvs.empty()) std::swap(copy.corner_uvs[f][1], copy.corner_uvs[f][2]);
  }
  return joined(mesh, copy);
}

// Every face has its own corners at the same positions.
TriangleMesh loose(const TriangleMesh& mesh) {
  return withShrunkenTriangles(mesh, 0);
}

// A brush covers everything; then random points of all faces must be painted.
void expectPaintedEverywhere(const TriangleMesh& mesh, const std::string& name) {
  const Scene scene = sceneOf(mesh, 40, 512);
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::color, 0.5);
  brush.falloff = 1e4;
  const Scene after = painted(surface, scene, strokeAt(brush, mesh.corner(0, 0)));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.05, 1);
  std::size_t bare = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    Vec3 w(unit(random), unit(random), unit(random));
    w /= w.sum();
    bare += surfaceValues(after, 0, {static_cast<std::int32_t>(f), w}).color[3] < 0.999;
  }
  EXPECT_EQ(bare, 0u) << name << ", of " << mesh.triangles.size();
}

TEST(PaintEverywhere, CoversMeshesWhoseCoordinatesOverlap) {
  const TriangleMesh shapes[] = {box(Vec3(0.05, 0.05, 0.05), 1), box(Vec3(0.05, 0.03, 0.08), 3),
                                 icosphere(0.03, 6), torus(0.03, 0.012, 24, 12)};
  for (std::size_t k = 0; k < std::size(shapes); ++k) {
    const std::string name = "shape " + std::to_string(k);
    expectPaintedEverywhere(boxMapped(shapes[k]), name + ", box-mapped");
    expectPaintedEverywhere(boxMapped(shapes[k], 3), name + ", tiled");
    expectPaintedEverywhere(onOneTriangle(shapes[k]), name + ", a chart a triangle");
    expectPaintedEverywhere(mirrored(shapes[k]), name + ", mirrored");
  }
}

TEST(PaintEverywhere, CoversMeshesWithEveryFaceTwice) {
  const TriangleMesh shapes[] = {box(Vec3(0.05, 0.05, 0.05), 2), icosphere(0.03, 10),
                                 torus(0.03, 0.012, 24, 12)};
  for (std::size_t k = 0; k < std::size(shapes); ++k) {
    const std::string name = "shape " + std::to_string(k);
    expectPaintedEverywhere(twice(shapes[k], false), name + " twice");
    expectPaintedEverywhere(twice(shapes[k], true), name + " and its inside");
    expectPaintedEverywhere(twice(boxMapped(shapes[k]), false), name + " twice, box-mapped");
    expectPaintedEverywhere(loose(twice(shapes[k], false)), name + " twice, loose");
    expectPaintedEverywhere(loose(shapes[k]), name + ", loose");
  }
}

TEST(PaintEverywhere, OneSideOfABoxMappedBoxIsPaintedAlone) {
  const double half = 0.025;
  for (const int cells : {1, 4}) {
    const Scene scene = sceneOf(boxMapped(box(Vec3::Constant(2 * half), cells)), 60, 256);
    const auto surface = surfaceOf(scene);
    EXPECT_TRUE(surface->objects[0].layout.generated);
    for (int side = 0; side < 6; ++side) {
      const auto middle = [&](int of) {
        return Vec3((of % 2 ? half : -half) * Vec3::Unit(of / 2));
      };
      Brush brush = brushOf(Tool::color, 0.01);
      brush.falloff = 1e4;
      const Scene after = painted(surface, scene, strokeAt(brush, middle(side)));
      for (int other = 0; other < 6; ++other)
        EXPECT_NEAR(valuesAt(*surface, after, middle(other)).color[3], other == side, 1e-6)
            << side << ' ' << other;
    }
  }
}

// The mesh's own picture appears at the mesh's coordinates, although the paint has its own atlas.
TEST(PaintEverywhere, PictureUsesTheMeshCoordinates) {
  Picture picture;
  picture.width = picture.height = 16;
  picture.channels = 3;
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i)
      for (const int value : {i, j, 0}) picture.texel.push_back(static_cast<float>(value) / 16);
  const TriangleMesh mesh = boxMapped(box(Vec3(0.05, 0.04, 0.03), 3));
  Scene scene = sceneOf(mesh, 60, 512);
  const auto surface = surfaceOf(scene);
  ASSERT_TRUE(surface->objects[0].layout.generated);
  scene.objects[0].paint =
      laid(*surface, scene, 0, picture, Projection::mapped, PictureTarget::color);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& uv = mesh.corner_uvs[f];
    const Vec2 at = (uv[0] + uv[1] + uv[2]) / 3;
    const auto color =
        surfaceValues(scene, 0, {static_cast<std::int32_t>(f), Vec3::Constant(1. / 3)}).color;
    EXPECT_NEAR(color[0], at[0] - 0.5 / 16, 0.02) << f;
    EXPECT_NEAR(color[1], at[1] - 0.5 / 16, 0.02) << f;
    EXPECT_NEAR(color[3], 1, 1e-6) << f;
  }
}

} // namespace
} // namespace patina
