// The texture below a point, by the kernels of both instruction sets.
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "scene/paint/relief_surface.h"
#include "scene/paint/texture_hit.h"
#include "scene/paint/texture_reader.h"
#include "support/relief_image.h"

namespace patina {

namespace texture_plain { // texture_look.cpp
void findTextureHit(const FaceTable& faces, const PatchTable& patches, double x, double y, double z,
                    std::int32_t near_face, TextureHit& foot, double* told) noexcept;
}

namespace {

const Vec3 kAt(0.3, -0.2, 0.1), kMiddle = kAt + Vec3(0.004, 0.007, 0.001);

// Two faces of a square of 1 cm, cut from kAt to the corner across; the second one's right angle is
// 1 cm from kAt along y.
struct Square {
  TriangleMesh mesh;
  std::vector<FaceFrame> frames{2};
  FaceTable faces{};

  Square() {
    mesh.positions = {kAt, kAt + Vec3(0.01, 0, 0), kAt + Vec3(0.01, 0.01, 0),
                      kAt + Vec3(0, 0.01, 0)};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    // w1, w2 and above by x, y and z; across edge 2 of the first and edge 0 of the second lies the
    // other.
    const auto bits = [](float value) { return std::bit_cast<std::int32_t>(value); };
    const std::int32_t side = bits(100), back = bits(-100), one = bits(1);
    frames[0].lanes[0] = Int4{side, 0, 0, -1};
    frames[0].lanes[1] = Int4{back, side, 0, -1};
    frames[0].lanes[2] = Int4{0, 0, one, 1};
    frames[1].lanes[0] = Int4{side, back, 0, 0};
    frames[1].lanes[1] = Int4{0, side, 0, -1};
    frames[1].lanes[2] = Int4{0, 0, one, -1};
    for (FaceFrame& frame : frames)
      for (int a = 0; a < 3; ++a) frame.corner[a] = static_cast<float>(kAt[a] - kMiddle[a]);
    for (int a = 0; a < 3; ++a) faces.middle[a] = kMiddle[a];
    faces.frames = frames.data();
  }
};

TEST(TextureKernel, FindsFaceAndHeightByEitherKernel) {
  const Square square;
  FourierTexture texture;
  texture.omega = 2 * 3.14159265358979 / 3e-3;
  for (int j = 1; j <= 40; ++j) {
    texture.series.a.push_back(1e-5 / j * std::cos(j));
    texture.series.b.push_back(1e-5 / j * std::sin(j));
  }
  texture.low = minHeight(texture);
  TextureMappings laid;
  laid.library[0] = hapticTexture(texture);
  for (std::int32_t f = 0; f < 2; ++f) {
    TexturedFace face;
    face.face = f;
    for (int c = 0; c < 3; ++c)
      face.coords[static_cast<std::size_t>(c)] =
          square.mesh.corner(static_cast<std::size_t>(f), c).head<2>() + Vec2(1, 0);
    laid.faces.push_back(face);
  }
  const TexturePatches patches(square.mesh, laid);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> in(5e-5, 0.01 - 5e-5), over(-1e-3, 1e-3);
  int other = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 from(in(random), in(random), over(random)), p = kAt + from;
    if (std::abs(from.x() - from.y()) < 5e-5) continue;
    const std::int32_t own = from.x() > from.y() ? 0 : 1, begin = i % 2;
    other += begin != own;
    for (const TextureKernel look :
         {textureKernel(), TextureKernel(&texture_plain::findTextureHit)}) {
      TextureHit foot;
      double told[2] = {7, 7};
      look(square.faces, patches.table(), p.x(), p.y(), p.z(), begin, foot, told);
      ASSERT_EQ(foot.face, own);
      ASSERT_NEAR(static_cast<double>(foot.above), from.z(), 1e-9);
      ASSERT_NE(foot.patch, nullptr);
      const TextureValue truth = laid.library[0]->evaluator.at(1 + p.x());
      ASSERT_NEAR(told[0], truth.height, 1e-15);
      ASSERT_NEAR(told[1], truth.gradient.x(), 1e-11);
    }
  }
  EXPECT_GT(other, 500);
  const Vec3 nowhere(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  for (const Vec3& p : {Vec3(kAt + Vec3(-1e-3, 5e-3, 0)), Vec3(kAt + Vec3(5e-3, 5e-3, 0)), nowhere})
    for (const TextureKernel look :
         {textureKernel(), TextureKernel(&texture_plain::findTextureHit)}) {
      TextureHit foot;
      double told[2] = {7, 7};
      look(square.faces, patches.table(), p.x(), p.y(), p.z(), 0, foot, told);
      EXPECT_EQ(foot.face, -1) << "beyond the rim, on an edge, or nowhere";
      for (const double kept : told) EXPECT_EQ(kept, 7);
    }
}

// A face without a texture, and a texture that is more than a line, are found but not evaluated.
TEST(TextureKernel, LeavesOtherTexturesToTheirEvaluators) {
  const Square square;
  FourierTexture waves;
  waves.kind = TextureKind::products;
  waves.omega = 2000;
  FourierSeries wave;
  wave.a = {1e-3};
  wave.b = {0};
  waves.products = {{wave, wave}};
  waves.low = minHeight(waves);
  TextureMappings laid;
  laid.library[0] = hapticTexture(waves);
  TexturedFace face;
  face.face = 0;
  for (int c = 0; c < 3; ++c)
    face.coords[static_cast<std::size_t>(c)] = square.mesh.corner(0, c).head<2>();
  laid.faces = {face};
  const TexturePatches patches(square.mesh, laid);
  for (const TextureKernel look : {textureKernel(), TextureKernel(&texture_plain::findTextureHit)})
    for (const bool textured : {true, false}) {
      const Vec3 p = kAt + (textured ? Vec3(7e-3, 2e-3, 0) : Vec3(2e-3, 7e-3, 0));
      TextureHit foot;
      double told[2] = {7, 7};
      look(square.faces, patches.table(), p.x(), p.y(), p.z(), 0, foot, told);
      EXPECT_EQ(foot.face, textured ? 0 : 1);
      ASSERT_EQ(foot.patch != nullptr, textured);
      for (const double kept : told) EXPECT_EQ(kept, 7);
      if (!textured) continue;
      EXPECT_EQ(foot.patch->texture->line.cells, nullptr);
      EXPECT_EQ(foot.patch->texture->texture, laid.library[0].get());
    }
}

// Undecided cases are left to the closest-point search, and the output stays unchanged.
TEST(TextureReader, RejectsInvalidEdgesImagesAndFaces) {
  const Square square;
  FourierTexture texture;
  texture.omega = 2000;
  texture.series.a = {1e-4};
  texture.series.b = {0};
  texture.low = minHeight(texture);
  TextureMappings laid;
  laid.library[0] = hapticTexture(texture);
  CornerUvs uvs(2);
  for (std::int32_t f = 0; f < 2; ++f) {
    TexturedFace face;
    face.face = f;
    for (std::size_t c = 0; c < 3; ++c) {
      face.coords[c] =
          square.mesh.corner(static_cast<std::size_t>(f), static_cast<int>(c)).head<2>();
      uvs[static_cast<std::size_t>(f)][c] = 10 * face.coords[c];
    }
    laid.faces.push_back(face);
  }
  ReliefSurface surface;
  surface.faces = reliefFaces(square.mesh, {});
  const ReliefSurface bare = surface;
  surface.textures = std::make_shared<const TexturePatches>(square.mesh, laid);
  ReliefSurface pictured = surface;
  pictured.faces = reliefFaces(square.mesh, uvs);
  pictured.image = test::reliefImage(64, [](double, double) { return 0.5; });
  pictured.height = 1e-3;

  const Vec3 within = kAt + Vec3(7e-3, 2e-3, 1e-4), on_edge = kAt + Vec3(5e-3, 5e-3, 0);
  ReliefAt at;
  ASSERT_TRUE(TextureReader(surface).read(within, 0, at));
  EXPECT_EQ(at.face, 0);
  EXPECT_NEAR(at.height, 1e-4 * std::cos(2000 * within.x()), 1e-15);
  const auto refuses = [](const ReliefSurface& of, const Vec3& p, std::int32_t near_face) {
    ReliefAt kept;
    const bool refused = !TextureReader(of).read(p, near_face, kept);
    return refused && kept.face == -1 && kept.height == 0 && kept.slope().isZero(0);
  };
  EXPECT_TRUE(refuses(surface, on_edge, 0));
  EXPECT_TRUE(refuses(surface, within, -1));
  EXPECT_TRUE(refuses(surface, within, 2));
  EXPECT_TRUE(refuses(bare, within, 0));
  EXPECT_TRUE(refuses(pictured, within, 0));
  EXPECT_NEAR(reliefAt(surface, on_edge, 0).distance, 0, 1e-8);
  EXPECT_EQ(reliefAt(surface, within, -1).face, -1);
}

} // namespace
} // namespace patina
