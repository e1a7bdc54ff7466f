// Strokes over a mesh become a texture's coordinates on its faces.
#include "acquisition/texture/map_texture.h"

#include <gtest/gtest.h>

#include "acquisition/files/registered_file.h"
#include "core/error.h"
#include "core/file.h"
#include "tests/acquisition/registration_shapes.h"

namespace patina {
namespace {

std::vector<Vec3> line(const Vec3& a, const Vec3& b, int n) {
  std::vector<Vec3> path;
  for (int i = 0; i <= n; ++i) path.push_back(a + (b - a) * (static_cast<double>(i) / n));
  return path;
}

TEST(LayTexture, GivesEachFaceTheNearestOfSeveralStrokes) {
  const MeshQuery ground(sheet(0.1, 0.1, 50));
  const Progress progress;
  const MappedTexture laid =
      mapTexture(ground,
                 {{line({-0.04, -0.01, 0.0003}, {0.04, -0.01, 0.0003}, 40), {}},
                  {line({0.04, 0.011, 0}, {-0.04, 0.011, 0}, 500), {}}},
                 {7, 6, Neighbours::by_vertex, 2}, progress);
  ASSERT_EQ(laid.lengths.size(), 2u);
  EXPECT_NEAR(laid.lengths[0], 0.08, 1e-12);
  EXPECT_NEAR(laid.lengths[1], 0.08, 1e-12);
  EXPECT_NEAR(laid.max_distance, 0.0003, 1e-12);
  EXPECT_NEAR(laid.max_stretch, 1, 1e-9);
  EXPECT_GT(laid.faces.size(), 900u);
  for (const TexturedFace& face : laid.faces) {
    EXPECT_EQ(face.texture, 7);
    const auto f = static_cast<std::size_t>(face.face);
    const Vec3 middle =
        (ground.mesh.corner(f, 0) + ground.mesh.corner(f, 1) + ground.mesh.corner(f, 2)) / 3;
    // The face is equally near to both, or beyond the ends, where one has wider rings.
    if (std::abs(middle.y() - 0.0005) < 1e-3 || std::abs(middle.x()) > 0.04) continue;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = ground.mesh.corner(f, k);
      const bool first = middle.y() < 0.0005;
      const Vec2 due = first ? Vec2(p.x() + 0.04, p.y() + 0.01) : Vec2(0.04 - p.x(), 0.011 - p.y());
      EXPECT_LT((face.coords[static_cast<std::size_t>(k)] - due).norm(), 1e-9) << p.transpose();
    }
  }
}

// Tremor across the path would lengthen it; the texture is mapped along the path without tremor.
TEST(LayTexture, PathIsNotLengthenedByTremor) {
  const MeshQuery ground(sheet(0.1, 0.1, 50)); // edges of 2 mm
  test::Draw draw(3);
  std::vector<Vec3> path = line({-0.04, 0, 0}, {0.04, 0, 0}, 2000);
  double raw = 0;
  for (Vec3& p : path) p += draw.normal(30e-6);
  for (std::size_t i = 1; i < path.size(); ++i) raw += (path[i] - path[i - 1]).head<2>().norm();
  const Progress progress;
  const MappedTexture laid = mapTexture(ground, {{path, {}}}, {}, progress);
  EXPECT_GT(raw, 0.09);
  EXPECT_NEAR(laid.lengths[0], 0.08, 2e-4);
}

TEST(LayTexture, UpperLayerReplacesLowerLayer) {
  const std::vector<TexturedFace> below = {{1, 1, {}}, {3, 1, {}}, {4, 1, {}}};
  const std::vector<TexturedFace> above = {{0, 2, {}}, {3, 2, {}}};
  const std::vector<TexturedFace> both = laidOver(above, below);
  ASSERT_EQ(both.size(), 4u);
  EXPECT_EQ(both[0].texture, 2);
  EXPECT_EQ(both[1].texture, 1);
  EXPECT_EQ(both[2].texture, 2);
  EXPECT_EQ(both[3].texture, 1);
}

TEST(LayTexture, SmoothingKeepsEndsLinesAndCircles) {
  const std::vector<Vec3> straight =
      resampledUniformly({line({0, 0, 0}, {0.1, 0, 0}, 333), {}}, 0.007).points;
  EXPECT_EQ(straight.front(), Vec3(0, 0, 0));
  EXPECT_EQ(straight.back(), Vec3(0.1, 0, 0));
  for (const Vec3& p : straight) EXPECT_LT(p.tail<2>().norm(), 1e-15);
  std::vector<double> errors;
  for (const double step : {4e-3, 2e-3, 1e-3}) {
    std::vector<Vec3> circle;
    for (int i = 0; i <= 3000; ++i) {
      const double angle = i * 1e-3;
      circle.emplace_back(0.03 * std::cos(angle), 0.03 * std::sin(angle), 0);
    }
    double most = 0;
    for (const Vec3& p : resampledUniformly({circle, {}}, step).points)
      most = std::max(most, 0.03 - p.norm());
    errors.push_back(most);
  }
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.9);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.9);
}

TEST(LayTexture, StrokesAreSplitAtPauses) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "strokes.csv";
  writeFileAtomically(file, "t [s],x [m],y [m],z [m]\n0,0,0,0\n0.1,1,0,0\n0.2,2,0,0\n1,3,0,0\n"
                            "1.1,4,0,0\n");
  const auto strokes = readStrokes(file);
  ASSERT_EQ(strokes.size(), 2u);
  EXPECT_EQ(strokes[0].points.size(), 3u);
  EXPECT_EQ(strokes[1].points[0], Vec3(3, 0, 0));
  writeFileAtomically(file, "x [m],y [m],z [m]\n0,0,0\n1,0,0\n");
  EXPECT_EQ(readStrokes(file).size(), 1u);
  writeFileAtomically(file, "t [s],x [m],y [m],z [m]\n0,0,0,0\n0,1,0,0\n");
  EXPECT_THROW(readStrokes(file), FileError);
  writeFileAtomically(file, "x [m],y [m],z [m]\n");
  EXPECT_THROW(readStrokes(file), FileError);
}

} // namespace
} // namespace patina
