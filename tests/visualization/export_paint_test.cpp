// Reads exports with VTK's own readers, like ParaView.
#include "visualization/export/export_paint.h"

#include <filesystem>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include "core/error.h"
#include "support/painted_objects.h"
#include "visualization/export/export_files.h"

namespace patina {
namespace {

constexpr double kSide = 0.04, kVoxel = 0.001;

std::set<std::string> arraysOf(vtkPointData* data) {
  std::set<std::string> names;
  for (int a = 0; a < data->GetNumberOfArrays(); ++a) names.insert(data->GetArrayName(a));
  return names;
}

class ExportPaint : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    scene_.relief.height = 0.002;
    scene_.haptics.stiffness = 700;
    SceneObject object = plate(kSide);
    object.world_from_object.translation() = Vec3(0.1, -0.2, 0.3);
    object.world_from_object.rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    ObjectPaint paint = paintOf(object);
    paint.color =
        imageOf(*object.mesh, *paint.layout.uvs, 64, kColorChannels, [](const Vec3&, float* rgba) {
          ink(rgba, {1, 0, 0.2}, 0.5);
        });
    paint.relief = imageOf(*object.mesh, *paint.layout.uvs, 64, 1, [](const Vec3& p, float* g) {
      *g = static_cast<float>(0.5 + p.x() / kSide);
    });
    auto map = std::make_shared<MaterialMap>(*materialOf(
        Box3(Vec3(-0.02, -0.02, -0.003), Vec3(0.02, 0.02, 0.003)), kVoxel,
        MaterialChannel::stiffness, [](const Vec3& p) { return 1000 + 1e4 * p.y(); },
        [](const Vec3& p) { return p.x() > 0; }));
    MaterialLayer& damping = map->writable({2, 2, 0}, MaterialChannel::damping);
    damping.value.fill(0.25F);
    damping.weight.fill(0.5F);
    paint.material = map;
    setPaint(object, paint);
    scene_.objects = {object};
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  template <typename Reader> vtkSmartPointer<Reader> read(const std::string& name) const {
    auto reader = vtkSmartPointer<Reader>::New();
    reader->SetFileName((folder_ / name).c_str());
    reader->Update();
    return reader;
  }
  const SceneObject& object() const { return scene_.objects.front(); }

  Scene scene_;
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("patina-export-paint-" + std::to_string(getpid()));
};

TEST_F(ExportPaint, SurfaceOfTwoTrianglesCarriesPaintAtItsPoints) {
  writePaintVtp(folder_ / "p.vtp", scene_, 0);
  const auto reader = read<vtkXMLPolyDataReader>("p.vtp");
  vtkPolyData* data = reader->GetOutput();
  vtkPointData* points = data->GetPointData();
  EXPECT_EQ(arraysOf(points), (std::set<std::string>{"texture coordinates", "color", "relief [m]",
                                                     "stiffness [N/m]", "damping [N s/m]"}));
  ASSERT_NE(points->GetTCoords(), nullptr);
  ASSERT_GT(data->GetNumberOfPoints(), 1000); // two triangles would show nothing
  const Material base = baseMaterial(scene_.haptics);
  const Pose object_from_world = object().world_from_object.inverse();
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p) {
    const Vec3 own = object_from_world * Vec3(data->GetPoint(p));
    ASSERT_NEAR(own.z(), 0, 1e-15);
    const Vec2 uv(points->GetTCoords()->GetTuple2(p));
    ASSERT_NEAR(uv[0], own.x() / kSide + 0.5, 1e-6);
    ASSERT_NEAR(uv[1], own.y() / kSide + 0.5, 1e-6);
    // The image ends half a texel before the edge.
    const double g = std::clamp(0.5 + own.x() / kSide, 0.5 / 64, 1 - 0.5 / 64);
    ASSERT_NEAR(points->GetArray("relief [m]")->GetTuple1(p), 0.002 * g, 1e-8);
    const Material felt = object().paint->material->at(own, base);
    ASSERT_NEAR(points->GetArray("stiffness [N/m]")->GetTuple1(p), felt.stiffness, 1e-6);
    ASSERT_NEAR(points->GetArray("damping [N s/m]")->GetTuple1(p), felt.damping, 1e-9);
    // Half of the paint over half of the object's own colour.
    const double* color = points->GetArray("color")->GetTuple3(p);
    ASSERT_NEAR(color[0], 255 * (0.5 + 0.5 * 0.68), 1);
    ASSERT_NEAR(color[1], 255 * (0.5 * 0.80), 1);
    ASSERT_NEAR(color[2], 255 * (0.1 + 0.5 * 0.64), 1);
  }
  EXPECT_EQ(points->GetArray("color")->GetDataType(), VTK_UNSIGNED_CHAR);
  double range[2];
  data->GetCellData()->GetArray("face")->GetRange(range);
  EXPECT_EQ(range[0], 0);
  EXPECT_EQ(range[1], 1);
}

TEST_F(ExportPaint, MaterialIsAVolumeInPlaceWithTheRenderedValues) {
  writeMaterialVti(folder_ / "m.vti", scene_, 0);
  const auto reader = read<vtkXMLImageDataReader>("m.vti");
  vtkImageData* image = reader->GetOutput();
  EXPECT_EQ(arraysOf(image->GetPointData()),
            (std::set<std::string>{"stiffness [N/m]", "damping [N s/m]"}));
  const MaterialMap& map = *object().paint->material;
  const Material base = baseMaterial(scene_.haptics);
  const Pose object_from_world = object().world_from_object.inverse();
  int painted = 0;
  for (vtkIdType p = 0; p < image->GetNumberOfPoints(); ++p) {
    Vec3 own = object_from_world * Vec3(image->GetPoint(p));
    // The point lies on the node: elsewhere the cells' other nodes contribute.
    const Vec3 node = ((own - map.origin()) / kVoxel).array().round();
    ASSERT_LT((own - map.origin() - kVoxel * node).norm(), 1e-6);
    own = map.origin() + kVoxel * node;
    const Material felt = map.at(own, base);
    ASSERT_NEAR(image->GetPointData()->GetArray("stiffness [N/m]")->GetTuple1(p), felt.stiffness,
                1e-3);
    ASSERT_NEAR(image->GetPointData()->GetArray("damping [N s/m]")->GetTuple1(p), felt.damping,
                1e-6);
    if (felt.stiffness != 700) ++painted;
  }
  EXPECT_GT(painted, 1000);
  EXPECT_LT(painted, image->GetNumberOfPoints());
}

TEST_F(ExportPaint, CollectionOpensSurfaceAndVolume) {
  writePaintVtp(folder_ / "p.vtp", scene_, 0);
  writeMaterialVti(folder_ / "m.vti", scene_, 0);
  writeCollectionVtm(folder_ / "all.vtm", {{"thing paint", "p.vtp"}, {"thing material", "m.vti"}});
  const auto reader = read<vtkXMLMultiBlockDataReader>("all.vtm");
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
  ASSERT_NE(blocks, nullptr);
  ASSERT_EQ(blocks->GetNumberOfBlocks(), 2U);
  auto* surface = vtkPolyData::SafeDownCast(blocks->GetBlock(0));
  auto* volume = vtkImageData::SafeDownCast(blocks->GetBlock(1));
  ASSERT_NE(surface, nullptr);
  ASSERT_NE(volume, nullptr);
  for (const char* name : {"stiffness [N/m]", "damping [N s/m]"}) {
    EXPECT_NE(surface->GetPointData()->GetArray(name), nullptr);
    EXPECT_NE(volume->GetPointData()->GetArray(name), nullptr);
  }
}

TEST_F(ExportPaint, UnpaintedLayersHaveNoArray) {
  SceneObject bare = object();
  ObjectPaint paint;
  paint.material = materialOf(
      Box3(Vec3::Constant(-0.004), Vec3::Constant(0.004)), kVoxel, MaterialChannel::static_friction,
      [](const Vec3&) { return 0.5; }, [](const Vec3&) { return true; });
  setPaint(bare, paint);
  scene_.objects = {bare};
  writePaintVtp(folder_ / "p.vtp", scene_, 0);
  const auto reader = read<vtkXMLPolyDataReader>("p.vtp");
  EXPECT_EQ(arraysOf(reader->GetOutput()->GetPointData()),
            std::set<std::string>{"friction.static"});
  EXPECT_EQ(reader->GetOutput()->GetPointData()->GetTCoords(), nullptr);

  scene_.objects.front().paint = nullptr;
  EXPECT_THROW(writePaintVtp(folder_ / "p.vtp", scene_, 0), std::invalid_argument);
  EXPECT_THROW(writeMaterialVti(folder_ / "m.vti", scene_, 0), std::invalid_argument);
}

TEST_F(ExportPaint, MissingFolderIsAFileError) {
  EXPECT_THROW(writePaintVtp(folder_ / "no" / "p.vtp", scene_, 0), FileError);
  EXPECT_THROW(writeMaterialVti(folder_ / "no" / "m.vti", scene_, 0), FileError);
}

} // namespace
} // namespace patina
