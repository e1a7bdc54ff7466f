#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/mesh/mesh_unit.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

TEST(MeshUnit, NamesReadBack) {
  for (const MeshUnit unit : {MeshUnit::mm, MeshUnit::cm, MeshUnit::m, MeshUnit::in, MeshUnit::fit})
    EXPECT_EQ(parseMeshUnit(name(unit)), unit);
  try {
    parseMeshUnit("ft");
    FAIL() << "ft was understood";
  } catch (const Error& error) {
    for (const char* choice : {"'ft'", "mm", "cm", "in", "fit"})
      EXPECT_NE(std::string(error.what()).find(choice), std::string::npos) << choice;
  }
}

TEST(MeshUnit, ScalesToMetres) {
  const TriangleMesh mesh = box(Vec3(50, 20, 10));
  const std::vector<std::pair<MeshUnit, double>> expected = {{MeshUnit::mm, 0.05},
                                                             {MeshUnit::cm, 0.5},
                                                             {MeshUnit::m, 50},
                                                             {MeshUnit::in, 1.27},
                                                             {MeshUnit::fit, 0.1}};
  for (const auto& [unit, side] : expected) {
    const ScaledMesh scaled = inMetres(mesh, unit);
    EXPECT_NEAR(bounds(scaled.mesh).sizes().x(), side, 1e-15) << name(unit);
    EXPECT_NEAR(scaled.scale, side / 50, 1e-15) << name(unit);
    EXPECT_EQ(scaled.warning.empty(), unit != MeshUnit::m) << scaled.warning;
  }
}

TEST(MeshUnit, WarnsOfImplausibleSizes) {
  for (const double side : {0.999, 2001.0}) {
    const std::string warning = inMetres(box(Vec3::Constant(side)), MeshUnit::mm).warning;
    EXPECT_NE(warning.find("--unit"), std::string::npos) << side;
    EXPECT_EQ(warning.find('\n'), std::string::npos);
  }
  for (const double side : {1.001, 1999.0})
    EXPECT_EQ(inMetres(box(Vec3::Constant(side)), MeshUnit::mm).warning, "") << side;
}

TEST(MeshUnit, SuggestionFitsAHand) {
  EXPECT_EQ(likelyUnit(110), MeshUnit::mm);
  EXPECT_EQ(likelyUnit(11), MeshUnit::cm);
  EXPECT_EQ(likelyUnit(0.11), MeshUnit::m);
  for (const double longest : {1.0, 1e4, 1e-3, 0.0, std::nan("")})
    EXPECT_EQ(likelyUnit(longest), MeshUnit::fit) << longest;
}

TEST(MeshUnit, FitIgnoresNonFiniteVerticesAndSurvivesAPoint) {
  TriangleMesh mesh = box(Vec3(4, 2, 1), 3);
  mesh.positions.push_back(Vec3::Constant(std::nan("")));
  mesh.positions.push_back(Vec3::Constant(1e9)); // unused: it does not count
  const auto bad = static_cast<std::int32_t>(mesh.positions.size()) - 2;
  mesh.triangles.push_back({0, 1, bad});
  EXPECT_NEAR(inMetres(mesh, MeshUnit::fit).scale, 0.025, 1e-15);
  TriangleMesh point;
  point.positions = {Vec3(7, 7, 7)};
  point.triangles = {{0, 0, 0}};
  EXPECT_EQ(inMetres(point, MeshUnit::fit).scale, 1.0);
  EXPECT_EQ(inMetres(point, MeshUnit::fit).mesh.positions[0], Vec3(7, 7, 7));
}

TEST(MeshUnit, RejectsCoordinatesBeyondTheLimitOnly) {
  const double far = kMaxCoordinate * (1 + 1e-9), near = kMaxCoordinate * (1 - 1e-9);
  const auto reaching = [](double y) {
    TriangleMesh mesh = box(Vec3::Ones());
    mesh.positions[0].y() = y;
    return mesh;
  };
  EXPECT_THROW(inMetres(reaching(1e305), MeshUnit::m), Error);
  EXPECT_THROW(inMetres(reaching(far), MeshUnit::m), Error);
  EXPECT_THROW(inMetres(reaching(-far), MeshUnit::m), Error);
  EXPECT_THROW(inMetres(reaching(1e3 * far), MeshUnit::mm), Error);
  EXPECT_NO_THROW(inMetres(reaching(near), MeshUnit::m));
  EXPECT_NO_THROW(inMetres(reaching(1e3 * near), MeshUnit::mm));
  EXPECT_NEAR(inMetres(box(Vec3::Constant(1e305)), MeshUnit::fit).mesh.positions.back().norm(),
              0.05 * std::sqrt(3.0), 1e-12);
}

} // namespace
} // namespace patina
