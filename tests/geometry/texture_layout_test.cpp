// Paint across an atlas's charts, and the choice between an atlas and the mesh's own coordinates.
#include <random>

#include "geometry/atlas/texel_map.h"
#include "geometry/atlas_checks.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/shapes.h"
#include "support/shared_data.h"

namespace patina {
namespace {

using test::Corners, test::expectAtlas, test::share, test::spiralRamp;

double sampled(const std::vector<double>& image, int size, const Vec2& uv) {
  const double x = std::clamp(uv[0] * size - 0.5, 0.0, size - 1.0);
  const double y = std::clamp(uv[1] * size - 0.5, 0.0, size - 1.0);
  const int i = std::min(static_cast<int>(x), size - 2),
            j = std::min(static_cast<int>(y), size - 2);
  const auto at = [&](int di, int dj) {
    return image[static_cast<std::size_t>((j + dj) * size + i + di)];
  };
  const double s = x - i, t = y - j;
  return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
}

// Paints a linear function of space through texels and reads it back: no line appears along a
// chart's edge.
void expectNoSeams(const TriangleMesh& mesh, int size) {
  const CornerUvs uvs = *generateAtlas(mesh, size).uvs;
  const TexelMap map = texelMap(uvs, size, size);
  const Vec3 slope = Vec3(0.48, -0.6, 0.64);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> image(map.owner.size(), nan);
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) {
      const std::int32_t face = map.ownerAt(i, j);
      if (face < 0) continue;
      const Vec3 weights =
          texelBarycentric(uvs[static_cast<std::size_t>(face)], (i + 0.5) / size, (j + 0.5) / size);
      image[static_cast<std::size_t>(j * size + i)] = slope.dot(position(mesh, {face, weights}));
    }
  // A texel is widest in space where a face is stretched most.
  double texel = 0;
  for (std::size_t f = 0; f < uvs.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      texel = std::max(
          texel,
          (mesh.corner(f, static_cast<int>(next)) - mesh.corner(f, static_cast<int>(k))).norm() /
              (uvs[f][next] - uvs[f][k]).norm() / size);
    }
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t f = 0; f < uvs.size(); ++f)
    for (int k = 0; k < 12; ++k) {
      Vec3 weights = Vec3(unit(random), unit(random), unit(random));
      if (k < 6) weights[k % 3] = 0;          // edges
      if (k < 3) weights = Vec3::Unit(k % 3); // corners
      weights /= weights.sum();
      const Corners& uv = uvs[f];
      const Vec2 at = weights[0] * uv[0] + weights[1] * uv[1] + weights[2] * uv[2];
      const double truth = slope.dot(position(mesh, {static_cast<std::int32_t>(f), weights}));
      ASSERT_NEAR(sampled(image, size, at), truth, 1.5 * texel) << "face " << f; // fails for NaN
    }
}

TEST(MadeAtlas, PaintShowsNoLineAlongAChartsEdge) {
  expectNoSeams(icosphere(1, 12), 256);
  expectNoSeams(icosphere(1, 40), 128); // faces below a texel
  expectNoSeams(box(Vec3(1, 2, 3), 2), 128);
  expectNoSeams(torus(1, 0.4, 36, 18), 256);
  expectNoSeams(spiralRamp(5, 0.3, 0.1, 0), 256);
  expectNoSeams(galleon(1), 512);
}

TEST(MadeAtlas, HoldsRealMeshes) {
  for (const char* name : {"goathead.obj", "boat.obj", "plane_holes.obj"}) {
    const auto path = test::sharedData(std::string("meshes/") + name);
    PATINA_SKIP_WITHOUT(path);
    const TriangleMesh mesh = readMesh(path);
    const TextureLayout layout = generateAtlas(mesh, 512);
    EXPECT_GT(share(layout), 0.4) << name;
    EXPECT_LT(layout.charts, 200) << name;
    if (mesh.triangles.size() < 10000) expectAtlas(mesh, layout, 512);
    expectNoSeams(mesh, 512);
  }
}

TriangleMesh mapped(TriangleMesh mesh) {
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    Corners uv;
    for (int k = 0; k < 3; ++k)
      uv[static_cast<std::size_t>(k)] = mesh.corner(f, k).head<2>() + Vec2(0.5, 0.5);
    mesh.corner_uvs.push_back(uv);
  }
  return mesh;
}

TEST(TextureLayout, KeepsTheMeshsOwnCoordinates) {
  const TriangleMesh mesh = mapped(sheet(1, 1, 4));
  const TextureLayout layout = textureLayout(mesh, 256);
  EXPECT_FALSE(layout.generated);
  EXPECT_EQ(ownLayoutFault(mesh), "");
  EXPECT_EQ(*layout.uvs, mesh.corner_uvs);
  EXPECT_EQ(layout.charts, 1);
}

// The right half of a sheet above the left one, or mirrored onto it.
TriangleMesh halved(bool apart) {
  TriangleMesh mesh = mapped(sheet(1, 1, 4));
  for (Corners& uv : mesh.corner_uvs) {
    const bool right = uv[0][0] + uv[1][0] + uv[2][0] > 1.5;
    for (Vec2& p : uv) {
      if (right) p[0] = 1 - p[0];
      if (apart) p[1] = 0.5 * p[1] + (right ? 0.5 : 0);
    }
  }
  return mesh;
}

TEST(TextureLayout, CountsPiecesOfTheMeshsOwnCoordinates) {
  const TextureLayout layout = textureLayout(halved(true), 256);
  EXPECT_FALSE(layout.generated);
  EXPECT_EQ(layout.charts, 2);
}

TEST(TextureLayout, MakesAnAtlasAndReportsWhyIfCoordinatesFail) {
  const TriangleMesh good = mapped(sheet(1, 1, 4));
  const auto expectMade = [](const TriangleMesh& mesh, const std::string& reason) {
    const std::string why = ownLayoutFault(mesh);
    const TextureLayout layout = textureLayout(mesh, 64);
    EXPECT_TRUE(layout.generated);
    EXPECT_NE(why.find(reason), std::string::npos) << why;
    TriangleMesh bare = mesh;
    bare.corner_uvs.clear();
    expectAtlas(bare, layout, 64);
  };
  expectMade(sheet(1, 1, 4), "no texture coordinates");
  expectMade(halved(false), "overlap");
  TriangleMesh mesh = good;
  mesh.corner_uvs.pop_back();
  expectMade(mesh, "missing");
  mesh = good;
  mesh.corner_uvs[5][1][0] = std::numeric_limits<double>::quiet_NaN();
  expectMade(mesh, "not finite");
  mesh = good;
  mesh.corner_uvs[7][2][1] = 1.01;
  expectMade(mesh, "leave the unit square");
  mesh = good;
  mesh.corner_uvs[7][2][1] = -1e-9;
  expectMade(mesh, "leave the unit square");
  mesh = good;
  for (Corners& uv : mesh.corner_uvs)
    for (Vec2& p : uv) p[1] = 0.3 * p[0] + 0.1; // all on one line
  expectMade(mesh, "no area");
  mesh.corner_uvs[3] = good.corner_uvs[3]; // one face with area is not enough
  expectMade(mesh, "no area on 31 triangles");
}

TEST(OwnLayoutFault, NamesASideWithoutAreaAndTooSmallCharts) {
  TriangleMesh mesh = sheet(1, 1, 4);
  for (const Triangle& t : mesh.triangles) {
    auto& uv = mesh.corner_uvs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      uv[k] = mesh.positions[static_cast<std::size_t>(t[k])].head<2>() + Vec2(0.5, 0.5);
  }
  EXPECT_EQ(ownLayoutFault(mesh), "");
  TriangleMesh flat = mesh;
  flat.corner_uvs[5].fill(Vec2(0.5, 0.5));
  EXPECT_EQ(ownLayoutFault(flat), "texture coordinates have no area on 1 triangles");
  for (auto& uv : mesh.corner_uvs)
    for (Vec2& p : uv) p *= 0.05;
  EXPECT_EQ(ownLayoutFault(mesh), "texture coordinates fill less than 1 % of the unit square");
}

} // namespace
} // namespace patina
