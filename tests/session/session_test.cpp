#include "session/open/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/file.h"
#include "geometry/atlas/texture_layout.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/shapes.h"
#include "session/open/stage_cost.h"
#include "support/fresh_folder.h"
#include "visualization/files/field_io.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

class Session : public testing::Test {
 protected:
  void SetUp() override { folder = test::freshFolder("session"); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  static Scene smallSphere() {
    Scene scene = sceneOf(icosphere(0.02, 8), "sphere");
    scene.field.resolution = 40;
    return scene;
  }

  std::filesystem::path write(const std::string& name, const TriangleMesh& mesh) const {
    writeMesh(folder / name, mesh);
    return folder / name;
  }

  std::filesystem::path folder;
  Progress progress;
};

TEST_F(Session, OpensAMeshInItsUnitUnderALegalName) {
  TriangleMesh mesh = icosphere(20, 4); // 20 mm in a file of mm
  writeMesh(folder / "my cup (2).ply", mesh);
  const OpenedScene mm = openScene(folder / "my cup (2).ply", {});
  ASSERT_EQ(mm.scene.objects.size(), 1u);
  EXPECT_EQ(mm.scene.objects[0].name, "my_cup__2_");
  EXPECT_NO_THROW(validate(mm.scene));
  EXPECT_TRUE(mm.warnings.empty());
  EXPECT_NEAR(bounds(*mm.scene.objects[0].mesh).max().z(), 0.02, 1e-3);
  const OpenedScene metres = openScene(folder / "my cup (2).ply", {MeshUnit::m, {}});
  EXPECT_NEAR(bounds(*metres.scene.objects[0].mesh).max().z(), 20, 1);
  ASSERT_EQ(metres.warnings.size(), 1u);
  EXPECT_NE(metres.warnings[0].find("--unit"), std::string::npos);
}

std::string refusalOf(const std::filesystem::path& path) {
  try {
    openScene(path, {});
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST_F(Session, UnreadableKindListsTheReadableKinds) {
  for (const char* name : {"a.gltf", "b.step", "c", "d.xyz", "E.PCD"}) {
    writeFileAtomically(folder / name, "x");
    const std::string refusal = refusalOf(folder / name);
    for (const char* kind : {".obj", ".ply", ".stl", ".vti", "workspace.json", "frames.csv"})
      EXPECT_NE(refusal.find(kind), std::string::npos) << refusal;
    EXPECT_EQ(refusal.find("point cloud") != std::string::npos, name[2] == 'x' || name[2] == 'P');
  }
  std::filesystem::create_directories(folder / "empty");
  std::filesystem::create_directories(folder / "scan" / "frames");
  EXPECT_NE(refusalOf(folder / "empty").find("not a workspace"), std::string::npos);
  EXPECT_NE(refusalOf(folder / "scan").find("patina scene -o WORKSPACE --scan"), std::string::npos);
}

TEST_F(Session, KeepsTheColoursOfAFileAsPaint) {
  writeFileAtomically(folder / "a.obj",
                      "v 0 0 0 1 0 0\nv 50 0 0 1 0 0\nv 0 50 0 1 0 0\nv 0 0 50 1 0 0\n"
                      "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const OpenedScene opened = openScene(folder / "a.obj", {});
  EXPECT_TRUE(opened.warnings.empty());
  ASSERT_TRUE(opened.scene.objects[0].paint && opened.scene.objects[0].paint->color);
  const ObjectPaint& paint = *opened.scene.objects[0].paint;
  const Vec2 middle =
      ((*paint.layout.uvs)[0][0] + (*paint.layout.uvs)[0][1] + (*paint.layout.uvs)[0][2]) / 3;
  EXPECT_EQ(paint.color->sample(middle.x(), middle.y(), 0), 1);
  EXPECT_EQ(paint.color->sample(middle.x(), middle.y(), 1), 0);
}

TEST_F(Session, WarnsOfDataThatTheMeshDrops) {
  writeFileAtomically(folder / "a.obj", "v 0 0 0\nv 50 0 0\nv 0 50 0\nv 0 0 50\nvt 0 0\nf 1/1 3/1 "
                                        "2/1\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const OpenedScene opened = openScene(folder / "a.obj", {});
  ASSERT_EQ(opened.warnings.size(), 1u);
  EXPECT_NE(opened.warnings[0].find("a.obj: the texture coordinates are left out"),
            std::string::npos);
}

TEST_F(Session, WarnsOfEveryKindOfDroppedTriangle) {
  TriangleMesh mesh = icosphere(20, 4);
  mesh.positions[3].x() = std::numeric_limits<double>::quiet_NaN();
  mesh.triangles[0] = {0, 0, 1};
  const MeshReport report = inspect(mesh);
  ASSERT_GT(report.non_finite, 0u);
  ASSERT_GT(report.degenerate, 0u);
  EXPECT_EQ(meshWarnings(report).size(), 2u);
  EXPECT_TRUE(meshWarnings(inspect(icosphere(20, 4))).empty());
}

TEST_F(Session, ReportsInOneLineWhyTextureCoordinatesCannotHoldPaint) {
  const auto lines = [](const OpenedScene& opened) {
    std::vector<std::string> found;
    for (const std::string& line : opened.warnings)
      if (line.find("texture coordinates") != std::string::npos) found.push_back(line);
    return found;
  };
  TriangleMesh mesh = icosphere(20, 4);
  EXPECT_TRUE(lines(openScene(write("plain.ply", mesh), {})).empty());
  mesh.corner_uvs = *generateAtlas(mesh, 256).uvs;
  EXPECT_TRUE(lines(openScene(write("unwrapped.ply", mesh), {})).empty());
  mesh.corner_uvs[7] = mesh.corner_uvs[3];
  const auto overlap = lines(openScene(write("overlap.ply", mesh), {}));
  ASSERT_EQ(overlap.size(), 1u);
  EXPECT_NE(overlap[0].find("overlap, those of triangles 3 and 7 for one"), std::string::npos);
  EXPECT_NE(overlap[0].find("atlas of its own"), std::string::npos);
  mesh.corner_uvs[7][0] = Vec2(1.5, 0);
  const auto tiled = lines(openScene(write("tiled.ply", mesh), {}));
  ASSERT_EQ(tiled.size(), 1u);
  EXPECT_NE(tiled[0].find("leave the unit square"), std::string::npos);
}

TEST_F(Session, AdvisesATipRadiusForSheetsUntilThereIsOne) {
  const auto advice = [](const OpenedScene& opened) {
    return std::count_if(opened.warnings.begin(), opened.warnings.end(), [](const auto& line) {
      return line.find("set surface.sides") != std::string::npos;
    });
  };
  writeMesh(folder / "ship.ply", galleon(100));
  EXPECT_EQ(advice(openScene(folder / "ship.ply", {})), 1);
  OpenOptions chosen;
  chosen.tip_radius_chosen = true;
  EXPECT_EQ(advice(openScene(folder / "ship.ply", chosen)), 0);
  Scene scene = sceneOf(galleon(0.1), "ship");
  saveWorkspace(scene, folder / "bare");
  EXPECT_EQ(advice(openScene(folder / "bare", {})), 1);
  scene.haptics.tip_radius = 0.001;
  saveWorkspace(scene, folder / "round");
  EXPECT_EQ(advice(openScene(folder / "round", {})), 0);
  scene.haptics.tip_radius.reset();
  scene.haptics.offset = 0.001;
  scene.field.sides = OpenSides::two;
  saveWorkspace(scene, folder / "both");
  EXPECT_EQ(advice(openScene(folder / "both", {})), 0);
}

TEST_F(Session, OpensAWorkspaceAsItWasSaved) {
  Scene scene = smallSphere();
  scene.haptics.stiffness = 321;
  saveWorkspace(scene, folder / "workspace");
  const OpenedScene opened = openScene(folder / "workspace", {});
  EXPECT_EQ(opened.scene.haptics.stiffness, 321);
  EXPECT_EQ(opened.scene.objects[0].mesh->positions, scene.objects[0].mesh->positions);
}

TEST_F(Session, OpensAFieldAsItsIsoSurfaceInMetres) {
  const Scene scene = smallSphere();
  const BuiltField built = buildField(worldMesh(scene), scene.field, progress);
  writeField(folder / "field.vti", *built.field);
  // The unit of meshes does not apply: a field file is in metres.
  const OpenedScene opened = openScene(folder / "field.vti", {MeshUnit::in, {}});
  EXPECT_NEAR(bounds(*opened.scene.objects[0].mesh).max().z(), 0.02, 3e-4);
  const OpenedScene outer = openScene(folder / "field.vti", {.iso = 0.002});
  EXPECT_NEAR(bounds(*outer.scene.objects[0].mesh).max().z(), 0.022, 3e-4);
  // The field is rendered as finely as it was written.
  EXPECT_EQ(opened.scene.field.voxel, built.field->grid.voxel);
  EXPECT_EQ(opened.scene.field.band, built.field->band);
}

TEST_F(Session, WorldMeshAppliesThePoseAndKeepsAnUntouchedMeshBitForBit) {
  Scene scene = smallSphere();
  EXPECT_EQ(worldMesh(scene).positions, scene.objects[0].mesh->positions);
  scene.objects[0].world_from_object.translation() = Vec3(1, 2, 3);
  EXPECT_NEAR((bounds(worldMesh(scene)).center() - Vec3(1, 2, 3)).norm(), 0, 1e-3);
}

TEST_F(Session, CompiledSceneRendersItsMesh) {
  const auto compiled = compile(smallSphere(), progress);
  EXPECT_EQ(compiled->mesh_report.triangles, 20u * 64);
  EXPECT_FALSE(compiled->built.field->sample.empty());
  ContactMemory memory;
  for (int i = 0; i < 20; ++i) // from outside: contact needs an entry
    (void)tick(*compiled->snapshot, memory, Vec3(0, 0, 0.021 - 0.0001 * i), 0.001);
  const Contact contact = tick(*compiled->snapshot, memory, Vec3(0, 0, 0.019), 0.001);
  EXPECT_TRUE(contact.touching);
  EXPECT_NEAR(contact.force.z(), 0.5, 0.1); // 1 mm at 500 N/m, minus the facet error
}

TEST_F(Session, RetuningKeepsTheFieldAndChangesTheForce) {
  const auto old = compile(smallSphere(), progress);
  Scene scene = old->scene;
  scene.haptics.stiffness = 250;
  const auto softer = withNewParameters(*old, scene);
  EXPECT_EQ(softer->built.field, old->built.field);
  EXPECT_NE(softer->snapshot, old->snapshot);
  EXPECT_EQ(softer->scene.haptics.stiffness, 250);
  const auto force = [](const CompiledScene& compiled) {
    ContactMemory memory;
    for (int i = 0; i < 20; ++i)
      (void)tick(*compiled.snapshot, memory, Vec3(0, 0, 0.021 - 0.0001 * i), 0.001);
    return tick(*compiled.snapshot, memory, Vec3(0, 0, 0.019), 0.001).force.norm();
  };
  EXPECT_NEAR(force(*softer), force(*old) / 2, 1e-12);
  scene.haptics.stiffness = -1;
  EXPECT_THROW(withNewParameters(*old, scene), Error);
}

TEST_F(Session, CancelledCompileThrowsAndKeepsNothing) {
  progress.cancel();
  EXPECT_THROW(compile(smallSphere(), progress), Cancelled);
}

TEST_F(Session, EmptySceneIsReported) {
  EXPECT_THROW(compile(Scene{}, progress), Error);
}

TEST_F(Session, EachEnabledStageHasAMeasuredCost) {
  Scene scene = smallSphere();
  scene.haptics.friction = Friction{0.5, 0.3};
  const auto compiled = compile(scene, progress);
  const std::vector<double> ns = stageNs(*compiled);
  ASSERT_EQ(ns.size(), compiled->snapshot->stages.size());
  for (const double cost : ns) {
    EXPECT_GE(cost, 0);
    EXPECT_LT(cost, 1e6);
  }
  EXPECT_GT(*std::max_element(ns.begin(), ns.end()), 5);
}

TEST_F(Session, MeshWithYUpIsRotatedToZ) {
  writeMesh(folder / "tall.obj", box(Vec3(2, 6, 4)));
  const OpenedScene turned = openScene(folder / "tall.obj", {.up = UpAxis::y});
  const Box3 at = bounds(*turned.scene.objects[0].mesh);
  EXPECT_LT((at.sizes() - Vec3(2e-3, 4e-3, 6e-3)).norm(), 1e-12);
  EXPECT_THROW(parseUpAxis("x"), Error);
}

} // namespace
} // namespace patina
