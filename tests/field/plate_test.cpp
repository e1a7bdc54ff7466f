// One-sided open parts as fronts of thickened sheets.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "field/construction/build_field.h"
#include "field/construction/distance_blocks.h"
#include "field/construction/thickened_sheet.h"
#include "field/store/node_reader.h"
#include "geometry/mesh/shapes.h"
#include "geometry/tree/triangle_tree.h"
#include "support/changed_mesh.h"
#include "support/mesh_defects.h"

namespace patina {
namespace {

using test::inverted;
using test::moved;

constexpr double kSide = 0.1; // [m]

BuiltField builtSheet(const TriangleMesh& mesh) {
  FieldSpec spec;
  spec.resolution = 100;
  Progress progress;
  return buildField(mesh, spec, progress);
}

// Calls visit(p, phi, face) at every stored node.
template <typename Visit> void forNodes(const SurfaceField& field, const Visit& visit) {
  for (std::size_t slot = 0; slot < field.blockCount(); ++slot) {
    DistanceNodes nodes;
    field.distance[slot]->unpack(nodes);
    const auto& at = field.block_at[slot];
    for (int n = 0; n < kBlockNodes; ++n)
      visit(field.grid.toWorld(kBlockSide * Vec3(at[0], at[1], at[2]) +
                               Vec3(n % 8, n / 8 % 8, n / 64)),
            static_cast<double>(nodes.phi[static_cast<std::size_t>(n)]),
            field.face[slot]->at(static_cast<std::size_t>(n)));
  }
}

template <typename Height> TriangleMesh hills(const Height& height, int cells = 60) {
  TriangleMesh mesh = sheet(kSide, kSide, cells);
  for (Vec3& p : mesh.positions) p.z() = height(p.x(), p.y());
  return mesh;
}

TriangleMesh halfBall() {
  TriangleMesh mesh = icosphere(0.05, 20);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.positions[static_cast<std::size_t>(t[0])].z() > -0.01;
  });
  return mesh;
}

TriangleMesh waves() {
  return hills([](double x, double y) { return 4e-3 * std::sin(90 * x) * std::cos(80 * y); });
}

std::vector<TriangleMesh> openMeshes() {
  const TriangleMesh flat = sheet(kSide, kSide, 10);
  return {flat,
          waves(),
          hills([](double x, double) { return 4e-3 * std::sin(400 * x); }, 100),
          hills([](double x, double) { return 0.02 - 3 * std::abs(x); }),
          hills([](double x, double) { return 3 * std::abs(x); }),
          hills([](double x, double y) { return 8 * (x * x - y * y); }),
          withHoles(sheet(kSide, kSide, 60), 6, 2e-3, 4),
          halfBall(),
          inverted(halfBall()),
          joined(flat, moved(flat, Vec3(1e-4, 0, 1e-3))),
          joined(flat, moved(flat, Vec3(0.02, 0.01, 4e-3))),
          joined(flat, moved(flat, Vec3(0.02, 0.01, 8e-3))),
          joined(flat, moved(icosphere(0.02, 20), Vec3(0, 0, 0.022))),
          {{Vec3(0, 0, 0), Vec3(0.08, 0.01, 0.02), Vec3(0.01, 0.06, 0.01)}, {{0, 1, 2}}, {}}};
}

// The edges of the back and of the sides are rounded by at most half a cell's diagonal.
TEST(Plate, IsABoxAsThickAsTheBandForASheet) {
  const TriangleMesh flat = sheet(kSide, kSide, 10);
  const SurfaceField field = *builtSheet(flat).field;
  const double thickness = field.band * field.grid.voxel;
  const TriangleMesh solid =
      moved(box(Vec3(kSide, kSide, thickness)), Vec3(0, 0, -0.5 * thickness));
  const TriangleTree tree(solid);
  double worst = 0;
  forNodes(field, [&](const Vec3& p, double phi, std::int32_t) {
    const bool within =
        std::max(std::abs(p.x()), std::abs(p.y())) < kSide / 2 && p.z() < 0 && p.z() > -thickness;
    const double truth = (within ? -1 : 1) * tree.closestPoint(p).distance / field.grid.voxel;
    if (std::abs(truth) < field.band - 1) worst = std::max(worst, std::abs(phi - truth));
  });
  std::printf("worst of all nodes: %.3f voxel\n", worst);
  EXPECT_LT(worst, std::sqrt(3.0) / 2);
}

TEST(Plate, KeepsTheFrontUnchanged) {
  const TriangleMesh mesh = waves();
  const SurfaceField field = *builtSheet(mesh).field;
  const TriangleTree tree(mesh);
  const double band = field.band, voxel = field.grid.voxel;
  std::size_t before = 0, behind = 0;
  forNodes(field, [&](const Vec3& p, double phi, std::int32_t) {
    if (std::max(std::abs(p.x()), std::abs(p.y())) > kSide / 2 - band * voxel) return;
    const double d = tree.closestPoint(p).distance / voxel;
    if (d > band || (phi < 0 && d > band / 2 - 0.5)) return;
    // The node lies halfway to the back.
    EXPECT_NEAR(std::abs(phi), d, 1e-4) << p.transpose();
    ++(phi < 0 ? behind : before);
  });
  EXPECT_GT(before, 10000U);
  EXPECT_GT(behind, 5000U);
}

// A distance differs between neighbours by no more than their spacing.
TEST(Plate, HasNoJumps) {
  int shape = 0;
  for (const TriangleMesh& mesh : openMeshes()) {
    const SurfaceField field = *builtSheet(mesh).field;
    double worst = 0;
    std::size_t judged = 0;
    NodeReader nodes(field);
    const FieldGrid& grid = field.grid;
    for (int k = 0; k + 1 < grid.nodes[2]; ++k)
      for (int j = 0; j + 1 < grid.nodes[1]; ++j)
        for (int i = 0; i + 1 < grid.nodes[0]; ++i) {
          const float phi = nodes.phiAt(i, j, k);
          if (std::abs(phi) > field.band) continue;
          for (const float next :
               {nodes.phiAt(i + 1, j, k), nodes.phiAt(i, j + 1, k), nodes.phiAt(i, j, k + 1)}) {
            if (std::abs(next) > field.band) continue;
            ++judged;
            worst = std::max(worst, static_cast<double>(std::abs(next - phi)));
          }
        }
    std::printf("shape %d: worst difference %.3f voxel\n", shape++, worst);
    EXPECT_GT(judged, 10000U);
    EXPECT_LT(worst, 1.1);
  }
}

TEST(Plate, HasTheFacesOfItsFront) {
  const TriangleMesh mesh = joined(sheet(kSide, kSide, 10), halfBall());
  const SurfaceField field = *builtSheet(mesh).field;
  const auto most = static_cast<std::int32_t>(mesh.triangles.size());
  std::size_t faces = 0;
  forNodes(field, [&](const Vec3& p, double phi, std::int32_t face) {
    ASSERT_LT(face, most);
    ASSERT_EQ(face >= 0, std::abs(phi) <= field.band);
    if (face < 0) return;
    ++faces;
    const auto f = static_cast<std::size_t>(face);
    const Vec3 centre = (mesh.corner(f, 0) + mesh.corner(f, 1) + mesh.corner(f, 2)) / 3;
    // Bound: the thickness of the sheet, the band behind it, and one face.
    ASSERT_LE((p - centre).norm(), 2 * field.band * field.grid.voxel + 0.01);
  });
  EXPECT_GT(faces, 100000U);
}

TEST(Plate, CapsStopIfCancelled) {
  const TriangleMesh mesh = sheet(kSide, kSide, 4);
  const TriangleTree tree(mesh);
  FieldSpec spec;
  spec.resolution = 40;
  Progress running, stopped;
  stopped.cancel();
  const FieldBuilder builder =
      distanceBlocks(mesh, tree, paddedForSheets(gridAround(bounds(mesh), spec), spec.band),
                     spec.band + 1.5, running, 0, 1);
  EXPECT_THROW((void)sheetCaps(builder, mesh, tree, openParts(mesh), spec.band, stopped),
               Cancelled);
}

// The back is a surface like any other.
TEST(Plate, ReachesItsBandPastItsBackAndItsSides) {
  const double side = 20, band = 4; // [voxel]
  FieldSpec spec;
  spec.voxel = 1;
  spec.band = band;
  Progress progress;
  const BuiltField made = buildField(sheet(side, side, 2), spec, progress);
  for (std::size_t slot = 0; slot < made.field->blockCount(); ++slot) {
    const auto& at = made.field->block_at[slot];
    EXPECT_EQ(made.field->slotOf(at[0], at[1], at[2]), static_cast<std::int32_t>(slot));
  }
  NodeReader nodes(*made.field);
  const auto phiNear = [&](const Vec3& p) {
    const Vec3 q = made.field->grid.toGrid(p).array().round();
    const Vec3 off = made.field->grid.toWorld(q) - p;
    EXPECT_LT(off.norm(), 1);
    return nodes.phiAt(static_cast<int>(q[0]), static_cast<int>(q[1]), static_cast<int>(q[2]));
  };
  for (const double out : {1.0, 2.0, 3.0}) {
    EXPECT_NEAR(phiNear(Vec3(0, 0, -band - out)), out, 0.9);
    for (const double way : {-1.0, 1.0}) {
      EXPECT_NEAR(phiNear(Vec3(way * (side / 2 + out), 0, -2)), out, 0.9);
      EXPECT_NEAR(phiNear(Vec3(0, way * (side / 2 + out), -2)), out, 0.9);
    }
  }
}

// The back is as large as the front, and the sides end a voxel below the boundary.
TEST(Plate, IsClosedByItsCaps) {
  const double side = 40, band = 6; // [voxel]
  FieldSpec spec;
  spec.voxel = 1;
  spec.band = band;
  Progress progress;
  for (int axis = 0; axis < 3; ++axis) {
    TriangleMesh front = sheet(side, side, 2);
    for (Vec3& p : front.positions)
      p = axis == 0 ? Vec3(p.z(), p.x(), p.y()) : axis == 1 ? Vec3(p.y(), p.z(), p.x()) : p;
    const BuiltField made = buildField(front, spec, progress);
    ASSERT_TRUE(made.caps);
    const double most = side * side + 4 * side * band, least = most - 4 * side;
    const double caps = area(made.caps->mesh);
    EXPECT_GT(caps, 0.97 * least) << axis;
    EXPECT_LT(caps, 1.03 * most) << axis;
  }
}

} // namespace
} // namespace patina
