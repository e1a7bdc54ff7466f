#include <filesystem>

#include <gtest/gtest.h>

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include "core/csv.h"
#include "core/error.h"
#include "geometry/mesh/shapes.h"
#include "support/fresh_folder.h"
#include "visualization/export/export_files.h"

namespace patina {
namespace {

class ExportFiles : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::vector<ToolSample> samples() const {
    std::vector<ToolSample> list(5);
    for (std::size_t i = 0; i < list.size(); ++i) {
      list[i].t = 0.001 * static_cast<double>(i);
      list[i].tip = Vec3(0.1 + static_cast<double>(i), -2, 1.0 / 3);
      list[i].force = Vec3(0, 0, 0.7);
      list[i].contact = i % 2 == 1;
      list[i].step_ns = 123;
    }
    return list;
  }
  const std::filesystem::path folder_ = test::freshFolder("export");
};

TEST_F(ExportFiles, MeshesReadBackInDoublePrecisionWithTheirFaceNumbers) {
  const TriangleMesh mesh = torus(0.035, 0.015, 12, 7);
  writeMeshVtp(folder_ / "m.vtp", mesh);
  const vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((folder_ / "m.vtp").c_str());
  reader->Update();
  vtkPolyData* back = reader->GetOutput();
  ASSERT_EQ(back->GetNumberOfPoints(), static_cast<vtkIdType>(mesh.positions.size()));
  ASSERT_EQ(back->GetNumberOfPolys(), static_cast<vtkIdType>(mesh.triangles.size()));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    ASSERT_EQ(Vec3(back->GetPoint(static_cast<vtkIdType>(i))), mesh.positions[i]);
  EXPECT_EQ(back->GetCellData()->GetArray("face")->GetTuple1(9), 9);
}

TEST_F(ExportFiles, ToolPathIsOneLineWithItsForces) {
  writeToolPathVtp(folder_ / "p.vtp", samples());
  const vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((folder_ / "p.vtp").c_str());
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfLines(), 1);
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 5);
  EXPECT_EQ(reader->GetOutput()->GetPointData()->GetArray("force [N]")->GetTuple3(3)[2], 0.7);
  writeToolPathVtp(folder_ / "empty.vtp", {});
  writeToolPathVtp(folder_ / "p.vtp", {samples()[0]});
  reader->Modified();
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 1);
}

TEST_F(ExportFiles, CollectionOpensItsParts) {
  writeMeshVtp(folder_ / "a.vtp", icosphere(1, 2));
  writeMeshVtp(folder_ / "b.vtp", icosphere(1, 3));
  writeCollectionVtm(folder_ / "all.vtm", {{"a & <a>", "a.vtp"}, {"b", "b.vtp"}});
  const vtkNew<vtkXMLMultiBlockDataReader> reader;
  reader->SetFileName((folder_ / "all.vtm").c_str());
  reader->Update();
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
  ASSERT_NE(blocks, nullptr);
  ASSERT_EQ(blocks->GetNumberOfBlocks(), 2U);
  EXPECT_EQ(vtkPolyData::SafeDownCast(blocks->GetBlock(1))->GetNumberOfPolys(), 180);
}

TEST_F(ExportFiles, ToolSamplesReadBackBitForBit) {
  writeToolSamplesCsv(folder_ / "s.csv", samples());
  const CsvTable table = readCsv(folder_ / "s.csv", {"t [s]", "x [m]", "y [m]", "z [m]"});
  ASSERT_EQ(table.rows.size(), 5U);
  EXPECT_EQ(table.rows[4][3], 1.0 / 3);
  EXPECT_EQ(table.rows[3][7], 1);
  EXPECT_EQ(table.columns.back(), "snap");
}

TEST_F(ExportFiles, MissingFolderIsAFileError) {
  EXPECT_THROW(writeMeshVtp(folder_ / "no" / "m.vtp", icosphere(1, 1)), FileError);
  EXPECT_THROW(writeCollectionVtm(folder_ / "no" / "m.vtm", {}), FileError);
}

} // namespace
} // namespace patina
