// An object's unit and upper axis are corrected after it was read.
#include "session/edit/reread_object.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

const Vec3 kSize(0.02, 0.03, 0.05);

Scene sceneWith(const TriangleMesh& mesh) {
  Scene scene;
  SceneObject& object = scene.objects.emplace_back();
  object.name = "block";
  object.mesh = std::make_shared<const TriangleMesh>(mesh);
  object.world_from_object.translation() = Vec3(0.1, 0.2, 0);
  return scene;
}

Vec3 inWorld(const Scene& scene, std::size_t vertex) {
  return scene.objects[0].world_from_object * scene.objects[0].mesh->positions[vertex];
}

TEST(RereadObject, IsAsIfItsFileHadBeenReadSo) {
  const TriangleMesh mesh = box(kSize);
  Scene scene = sceneWith(mesh);
  const Scene right = sceneWith(zUp(inMetres(box(1e3 * kSize), MeshUnit::cm).mesh, UpAxis::y));
  scene.pins = {{"A", inWorld(scene, 3)}};
  const Scene now = withReread(scene, "block", scene.objects[0].mesh.get(), MeshUnit::mm,
                               MeshUnit::cm, UpAxis::y);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    EXPECT_LT((inWorld(now, v) - inWorld(right, v)).norm(), 1e-12);
  EXPECT_LT((now.pins[0].position - inWorld(now, 3)).norm(), 1e-12); // stays on the surface
}

TEST(RereadObject, ChangesNothingIfTheFileWasReadRight) {
  const Scene scene = sceneWith(box(kSize));
  const TriangleMesh* mesh = scene.objects[0].mesh.get();
  const Scene now = withReread(scene, "block", mesh, MeshUnit::cm, MeshUnit::cm, UpAxis::z);
  EXPECT_EQ(now.objects[0].mesh.get(), mesh);
  EXPECT_TRUE(now.objects[0].world_from_object.isApprox(scene.objects[0].world_from_object));
}

TEST(RereadObject, RefusesWhatWouldMoveScansOrPinsOrAnotherMesh) {
  const Scene plain = sceneWith(box(kSize));
  const TriangleMesh* mesh = plain.objects[0].mesh.get();
  const auto refusal = [&](const Scene& scene, const TriangleMesh* asked, MeshUnit now,
                           UpAxis up) -> std::string {
    try {
      withReread(scene, "block", asked, MeshUnit::mm, now, up);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  Scene scanned = plain;
  scanned.scans.emplace_back().name = "hand";
  EXPECT_NE(refusal(scanned, mesh, MeshUnit::cm, UpAxis::z).find("the scan hand"),
            std::string::npos);
  EXPECT_NE(refusal(scanned, mesh, MeshUnit::mm, UpAxis::y).find("the scan hand"),
            std::string::npos);
  EXPECT_EQ(refusal(scanned, mesh, MeshUnit::mm, UpAxis::z), "");
  Scene two = plain;
  two.objects.push_back(plain.objects[0]);
  two.objects[1].name = "other";
  EXPECT_EQ(refusal(two, mesh, MeshUnit::cm, UpAxis::z), "");
  two.pins = {{"A", Vec3::Zero()}};
  EXPECT_NE(refusal(two, mesh, MeshUnit::cm, UpAxis::z).find("the pin A"), std::string::npos);
  const TriangleMesh another = *mesh;
  EXPECT_NE(refusal(plain, &another, MeshUnit::cm, UpAxis::z).find("has changed"),
            std::string::npos);
}

} // namespace
} // namespace patina
