#include "authoring/images/apply_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "authoring/paint_fixture.h"
#include "core/error.h"

namespace patina {
namespace {

using test::sceneOf;
using test::surfaceOf;
using test::valuesAt;

// Red grows to the right, green upward.
Picture ramp(int width, int height) {
  Picture picture{width, height, 3, {}};
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      picture.texel.push_back((static_cast<float>(i) + 0.5f) / static_cast<float>(width));
      picture.texel.push_back((static_cast<float>(j) + 0.5f) / static_cast<float>(height));
      picture.texel.push_back(0);
    }
  return picture;
}

Picture plain(int channels, std::initializer_list<float> texel, int side = 4) {
  Picture picture{side, side, channels, {}};
  for (int k = 0; k < side * side; ++k)
    picture.texel.insert(picture.texel.end(), texel.begin(), texel.end());
  return picture;
}

Scene with(const Scene& scene, std::shared_ptr<const ObjectPaint> paint) {
  Scene result = scene;
  result.objects[0].paint = std::move(paint);
  return result;
}

// A sheet whose coordinates run `times` times over the unit square in u, and once in v.
TriangleMesh mappedSheet(double times, double mirrored) {
  TriangleMesh mesh = sheet(0.1, 0.1, 8);
  for (const Triangle& t : mesh.triangles) {
    auto& uv = mesh.corner_uvs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.positions[static_cast<std::size_t>(t[k])];
      uv[k] = Vec2(times * (mirrored * p.x() / 0.1 + 0.5), p.y() / 0.1 + 0.5);
    }
  }
  return mesh;
}

// T-K21e: the picture is upright, seen along each axis.
TEST(LayImage, ProjectsUprightAndNotMirrored) {
  const Scene scene = sceneOf(box(Vec3(0.1, 0.08, 0.06), 5), 60, 256);
  const auto surface = surfaceOf(scene);
  struct View {
    Projection projection;
    Vec3 on, right, up; // the middle of the visible face
  };
  for (const View& view :
       {View{Projection::z, Vec3(0, 0, 0.03), Vec3(0.05, 0, 0), Vec3(0, 0.04, 0)},
        View{Projection::x, Vec3(0.05, 0, 0), Vec3(0, 0.04, 0), Vec3(0, 0, 0.03)},
        View{Projection::y, Vec3(0, -0.04, 0), Vec3(0.05, 0, 0), Vec3(0, 0, 0.03)}}) {
    const Scene after =
        with(scene, laid(*surface, scene, 0, ramp(64, 64), view.projection, PictureTarget::color));
    for (const double x : {-0.8, 0.0, 0.8})
      for (const double y : {-0.8, 0.1, 0.8})
        for (const double side : {1.0, -1.0}) { // the far face, too
          const Vec3 p = side * view.on + x * view.right + y * view.up;
          const auto color = valuesAt(*surface, after, p).color;
          EXPECT_NEAR(color[0], 0.5 + x / 2, 0.02);
          EXPECT_NEAR(color[1], 0.5 + y / 2, 0.02);
          EXPECT_NEAR(color[3], 1, 1e-6);
        }
  }
}

TEST(LayImage, FollowsTheMeshsCoordinatesRepeatedAndMirrored) {
  for (const double times : {1.0, 3.0})
    for (const double mirrored : {1.0, -1.0}) {
      const Scene scene = sceneOf(mappedSheet(times, mirrored), 60, 512);
      const auto surface = surfaceOf(scene);
      EXPECT_EQ(surface->objects[0].layout.generated, times > 1);
      const Scene after = with(
          scene, laid(*surface, scene, 0, ramp(64, 64), Projection::mapped, PictureTarget::color));
      for (double x = -0.0485; x < 0.05; x += 0.0037) {
        const double u = times * (mirrored * x / 0.1 + 0.5), inside = u - std::floor(u);
        if (inside < 0.06 || inside > 0.94) continue; // the seam of the picture
        EXPECT_NEAR(valuesAt(*surface, after, Vec3(x, 0.02, 0)).color[0], inside, 0.03) << x;
        EXPECT_NEAR(valuesAt(*surface, after, Vec3(x, 0.02, 0)).color[1], 0.7, 0.03);
      }
    }
}

TEST(LayImage, KeepsTexelsOutsideThePicture) {
  const Scene scene = sceneOf(box(Vec3(0.1, 0.1, 0.1), 3));
  const auto surface = surfaceOf(scene);
  const auto lay = [&](const Scene& on, const Picture& picture, PictureTarget target) {
    return with(on, laid(*surface, on, 0, picture, Projection::z, target));
  };
  const Vec3 p(0.01, 0.02, 0.05);
  const Scene red = lay(scene, plain(4, {1, 0, 0, 1}), PictureTarget::color);
  const Scene both = lay(red, plain(4, {0, 0, 1, 0.25}), PictureTarget::color);
  const auto color = valuesAt(*surface, both, p).color;
  EXPECT_NEAR(color[0], 0.75, 1e-6);
  EXPECT_NEAR(color[2], 0.25, 1e-6);
  EXPECT_NEAR(color[3], 1, 1e-6);
  const Scene half = lay(scene, plain(2, {1, 0.5}), PictureTarget::color);
  EXPECT_NEAR(valuesAt(*surface, half, p).color[1], 0.5, 1e-6);
  EXPECT_NEAR(valuesAt(*surface, half, p).color[3], 0.5, 1e-6);
  const Scene raised = lay(red, plain(1, {0.5}), PictureTarget::relief);
  EXPECT_NEAR(valuesAt(*surface, raised, p).height, 0.5 * scene.relief.height, 1e-9);
  EXPECT_TRUE(same(*raised.objects[0].paint->color, *red.objects[0].paint->color));
  const Scene clear = lay(raised, plain(2, {1, 0}), PictureTarget::relief);
  EXPECT_TRUE(same(*clear.objects[0].paint->relief, *raised.objects[0].paint->relief));
}

// A picture finer than the image is averaged, not point-sampled.
TEST(LayImage, FinePicturesDoNotAlias) {
  Picture picture{1024, 1024, 1, {}};
  for (int j = 0; j < 1024; ++j)
    for (int i = 0; i < 1024; ++i) picture.texel.push_back(static_cast<float>((i ^ j) & 1));
  const Scene scene = sceneOf(box(Vec3(0.1, 0.1, 0.02), 3), 60, 256);
  const auto surface = surfaceOf(scene);
  const Scene after =
      with(scene, laid(*surface, scene, 0, picture, Projection::z, PictureTarget::relief));
  for (double x = -0.04; x < 0.04; x += 0.0031)
    EXPECT_NEAR(valuesAt(*surface, after, Vec3(x, 0.4 * x, 0.01)).height, 0.5e-3, 0.1e-3);
}

TEST(LayImage, RejectsMisuse) {
  const Scene scene = sceneOf(box(Vec3(0.1, 0.1, 0.02), 3));
  const auto surface = surfaceOf(scene);
  const auto lay = [&](const PaintSurface& on, const Picture& picture, Projection projection) {
    return laid(on, scene, 0, picture, projection, PictureTarget::color);
  };
  EXPECT_THROW(lay(*surface, ramp(4, 4), Projection::mapped), Error);
  EXPECT_THROW(lay(*surfaceOf(scene, false), ramp(4, 4), Projection::x), std::invalid_argument);
  EXPECT_THROW(lay(*surface, Picture{}, Projection::x), std::invalid_argument);
  Picture torn = ramp(4, 4);
  torn.texel.pop_back();
  EXPECT_THROW(lay(*surface, torn, Projection::x), std::invalid_argument);
}

} // namespace
} // namespace patina
