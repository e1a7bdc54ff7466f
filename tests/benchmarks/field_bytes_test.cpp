// Bytes of distance + face at 150^3, band 8, against a dense box of the same grid (must: 0.28).
#include <gtest/gtest.h>

#include "field/build_field.h"
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

TEST(FieldBytes, StayBelowSevenTwentyFifthsOfADenseBox) {
  EXPECT_LE(shareOfDenseBox(icosphere(0.05, 22)), 0.28);
  EXPECT_LE(shareOfDenseBox(icosphere(0.05, 71)), 0.28);
}

TEST(FieldBytes, StayBelowSevenTwentyFifthsOfADenseBoxOnAScannedShape) {
  const auto path = test::sharedData("meshes/goathead.obj");
  PATINA_SKIP_WITHOUT(path);
  EXPECT_LE(shareOfDenseBox(inMetres(readMesh(path), MeshUnit::fit).mesh), 0.28);
}

} // namespace
} // namespace patina
