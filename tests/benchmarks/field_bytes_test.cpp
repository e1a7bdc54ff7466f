// Bytes of distance + face at 150^3, band 8, against a dense box of the same grid: at most 0.28,
// also where a surface's band fills so much of its box that plain floats alone would not fit.
#include <cmath>
#include <cstdio>
#include <utility>

#include <gtest/gtest.h>

#include "field/construction/build_field.h"
#include "field/surface/models.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/mesh_unit.h"
#include "geometry/mesh/shapes.h"
#include "support/shared_data.h"

namespace patina {
namespace {

constexpr double kMost = 0.28;

double shareOfDenseBox(const char* name, const TriangleMesh& mesh) {
  Progress progress;
  const BuiltField built = buildField(mesh, FieldSpec{}, progress);
  std::size_t stored = 0;
  for (const LayerBytes& layer : built.field->layerBytes()) {
    if (layer.name == "distance" || layer.name == "face") stored += layer.bytes;
    EXPECT_NE(layer.name, "sample") << "nobody has felt this field yet";
  }
  const auto dense = built.field->grid.nodeCount() * (sizeof(float) + sizeof(std::int32_t));
  EXPECT_EQ(built.report.dense_bytes, dense);
  const double share = static_cast<double>(stored) / static_cast<double>(dense);
  std::printf("%-24s %.3f of a dense box\n", name, share);
  return share;
}

// A solid with an inner edge: an L pushed up.
TriangleMesh bracket() {
  constexpr double corner[6][2] = {{0, 0},       {0.06, 0},    {0.06, 0.02},
                                   {0.02, 0.02}, {0.02, 0.05}, {0, 0.05}};
  TriangleMesh mesh;
  for (const double z : {0.0, 0.06})
    for (const auto& [x, y] : corner) mesh.positions.push_back({x, y, z});
  const Triangle caps[] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  for (const Triangle& t : caps) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
  }
  for (std::int32_t a = 0; a < 6; ++a) {
    const std::int32_t b = (a + 1) % 6;
    mesh.triangles.push_back({a, b, b + 6});
    mesh.triangles.push_back({a, b + 6, a + 6});
  }
  return mesh;
}

TEST(FieldBytes, StayBelowSevenTwentyFifthsOfADenseBoxOnAnyShape) {
  TriangleMesh terrain = sheet(0.1, 0.1, 100);
  for (Vec3& p : terrain.positions) p.z() = 0.006 * std::sin(100 * p.x()) * std::cos(80 * p.y());
  const std::pair<const char*, TriangleMesh> shapes[] = {
      {"sphere", icosphere(0.05, 71)},
      {"coarse sphere", icosphere(0.05, 22)},
      {"vase", vase(0.12, 0.004, 48, 25)},
      {"galleon", galleon(0.1)},
      {"dinosaur", dinosaur(200)},
      {"torus", torus(0.04, 0.015, 128, 64)},
      {"thin torus", torus(0.045, 0.002, 256, 16)},
      {"bracket", bracket()},
      {"box", box({0.06, 0.05, 0.04}, 8)},
      {"plate", box({0.1, 0.1, 0.001}, 8)},
      {"rod", box({0.1, 0.003, 0.003}, 8)},
      {"terrain", std::move(terrain)}};
  for (const auto& [name, mesh] : shapes) EXPECT_LE(shareOfDenseBox(name, mesh), kMost) << name;
}

TEST(FieldBytes, StayBelowSevenTwentyFifthsOfADenseBoxOnSharedModels) {
  for (const char* name : {"meshes/goathead.obj", "meshes/boat.obj", "meshes/plane_holes.obj",
                           "contact_paths/L.obj"}) {
    const auto path = test::sharedData(name);
    PATINA_SKIP_WITHOUT(path);
    EXPECT_LE(shareOfDenseBox(name, inMetres(readMesh(path), MeshUnit::fit).mesh), kMost) << name;
  }
}

} // namespace
} // namespace patina
