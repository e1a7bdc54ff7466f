// Bytes of distance + face at 150^3, band 8, against a dense box of the same grid (must: 0.28), and
// for each node of the band: how much of its box a surface's band fills is the shape's own matter.
#include <cmath>
#include <cstdio>
#include <utility>

#include <gtest/gtest.h>

#include "field/build_field.h"
#include "field/models.h"
#include "geometry/mesh_io.h"
#include "geometry/mesh_unit.h"
#include "geometry/shapes.h"
#include "support/shared_data.h"

namespace patina {
namespace {

double shareOfDenseBox(const TriangleMesh& mesh) {
  Progress progress;
  const BuiltField built = buildField(mesh, FieldSpec{}, progress);
  std::size_t stored = 0;
  for (const LayerBytes& layer : built.field->layerBytes()) {
    if (layer.name == "distance" || layer.name == "face") stored += layer.bytes;
    EXPECT_NE(layer.name, "sample") << "nobody has felt this field yet";
  }
  const auto dense = built.field->grid.nodeCount() * (sizeof(float) + sizeof(std::int32_t));
  EXPECT_EQ(built.report.dense_bytes, dense);
  return static_cast<double>(stored) / static_cast<double>(dense);
}

struct BandBytes {
  double each = 0;   // bytes a node of the band
  double filled = 0; // share of the grid's nodes that lie in the band
};

BandBytes bandBytes(const TriangleMesh& mesh) {
  Progress progress;
  const BuiltField built = buildField(mesh, FieldSpec{}, progress);
  const SurfaceField& field = *built.field;
  std::size_t stored = 0, band = 0;
  for (const LayerBytes& layer : field.layerBytes())
    if (layer.name == "distance" || layer.name == "face") stored += layer.bytes;
  for (int k = 0; k < field.grid.nodes[2]; ++k)
    for (int j = 0; j < field.grid.nodes[1]; ++j)
      for (int i = 0; i < field.grid.nodes[0]; ++i)
        band += std::abs(field.phiAt(i, j, k)) < kBeyondBand;
  return {static_cast<double>(stored) / static_cast<double>(band),
          static_cast<double>(band) / static_cast<double>(field.grid.nodeCount())};
}

constexpr double kMostEach = 9.2; // 8 of distance and face, were nothing else stored

TEST(FieldBytes, AreNineForANodeOfTheBandOnAnyShape) {
  TriangleMesh terrain = sheet(0.1, 0.1, 100);
  for (Vec3& p : terrain.positions) p.z() = 0.006 * std::sin(100 * p.x()) * std::cos(80 * p.y());
  const std::pair<const char*, TriangleMesh> shapes[] = {{"sphere", icosphere(0.05, 71)},
                                                         {"vase", vase(0.12, 0.004, 48, 25)},
                                                         {"galleon", galleon(0.1)},
                                                         {"dinosaur", dinosaur(200)},
                                                         {"torus", torus(0.04, 0.015, 128, 64)},
                                                         {"box", box({0.06, 0.05, 0.04}, 8)},
                                                         {"terrain", std::move(terrain)}};
  for (const auto& [name, mesh] : shapes) {
    const BandBytes bytes = bandBytes(mesh);
    std::printf("%-10s %.2f bytes a node of the band, which fills %.3f of the box\n", name,
                bytes.each, bytes.filled);
    EXPECT_LE(bytes.each, kMostEach) << name;
  }
}

// A float for each node of the band is more than is asked for all: no form of them fits there.
TEST(FieldBytes, CannotStayBelowThatWhereTheBandFillsTheBox) {
  for (const TriangleMesh& mesh : {box({0.06, 0.05, 0.04}, 8), box({0.1, 0.1, 0.001}, 8)})
    EXPECT_GT(sizeof(float) * bandBytes(mesh).filled,
              0.28 * (sizeof(float) + sizeof(std::int32_t)));
}

TEST(FieldBytes, StayBelowSevenTwentyFifthsOfADenseBox) {
  EXPECT_LE(shareOfDenseBox(icosphere(0.05, 22)), 0.28);
  EXPECT_LE(shareOfDenseBox(icosphere(0.05, 71)), 0.28);
}

TEST(FieldBytes, StayBelowSevenTwentyFifthsOfADenseBoxOnAScannedShape) {
  const auto path = test::sharedData("meshes/goathead.obj");
  PATINA_SKIP_WITHOUT(path);
  EXPECT_LE(shareOfDenseBox(inMetres(readMesh(path), MeshUnit::fit).mesh), 0.28);
}

TEST(FieldBytes, AreNineForANodeOfTheBandOnScannedShapes) {
  for (const char* name : {"meshes/goathead.obj", "meshes/boat.obj", "meshes/plane_holes.obj"}) {
    const auto path = test::sharedData(name);
    PATINA_SKIP_WITHOUT(path);
    EXPECT_LE(bandBytes(inMetres(readMesh(path), MeshUnit::fit).mesh).each, kMostEach) << name;
  }
}

} // namespace
} // namespace patina
