#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkShortArray.h>
#include <vtkSignedCharArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnsignedIntArray.h>
#include <vtkUnsignedLongLongArray.h>
#include <vtkUnsignedShortArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>

#include "core/error.h"
#include "core/file.h"
#include "field/store/surface_field.h"
#include "geometry/mesh/mesh_report.h"
#include "support/fresh_folder.h"
#include "support/node_values.h"
#include "visualization/files/field_io.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class FieldIo : public ::testing::Test {
 protected:
  void SetUp() override { folder_ = test::freshFolder("field_io"); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path file(const std::string& name) const { return folder_ / name; }

 private:
  fs::path folder_;
};

double sphereValue(const Vec3& p) {
  return p.norm() - 0.03;
}

SurfaceField sphereField(int resolution = 43) { // no multiple of the block side
  FieldSpec spec;
  spec.resolution = resolution;
  spec.band = 3;
  const FieldGrid grid = gridAround(Box3(Vec3::Constant(-0.03), Vec3::Constant(0.03)), spec);
  return sampleFunction(sphereValue, grid, spec.band);
}

// Adds a face layer with a different number at each node.
void addFaces(SurfaceField& field) {
  std::int32_t next = 7;
  for (const auto& distance : field.distance) {
    FaceNodes faces{};
    const auto phi = distance->phi();
    for (std::size_t n = 0; n < faces.face.size(); ++n)
      faces.face[n] = std::abs(phi[n]) < kBackground ? next++ : -1;
    field.face.push_back(std::make_shared<const FaceBlock>(faces));
  }
}

void expectSameNodes(const SurfaceField& a, const SurfaceField& b) {
  ASSERT_EQ(a.grid.nodes, b.grid.nodes);
  for (int k = -1; k <= a.grid.nodes[2]; ++k)
    for (int j = -1; j <= a.grid.nodes[1]; ++j)
      for (int i = -1; i <= a.grid.nodes[0]; ++i) {
        ASSERT_EQ(test::phiAt(a, i, j, k), test::phiAt(b, i, j, k)) << i << ' ' << j << ' ' << k;
        if (!a.face.empty()) {
          ASSERT_EQ(a.faceAt(i, j, k), b.faceAt(i, j, k));
        }
      }
}

std::string messageOf(const fs::path& path) {
  try {
    readField(path);
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST_F(FieldIo, StoredNodesComeBackBitForBit) {
  SurfaceField field = sphereField();
  addFaces(field);
  field.coarse.resize(static_cast<std::size_t>((field.blocks[0] + 1) * (field.blocks[1] + 1) *
                                               (field.blocks[2] + 1)));
  std::mt19937 random(3);
  for (CoarseNode& node : field.coarse)
    node = {static_cast<float>(random()), 0.1F, -0.2F, static_cast<float>(random()) * 1e-9F};
  writeField(file("f.vti"), field);
  const SurfaceField back = readField(file("f.vti"));
  EXPECT_EQ(back.grid.origin, field.grid.origin);
  EXPECT_EQ(back.grid.voxel, field.grid.voxel);
  EXPECT_EQ(back.band, field.band);
  EXPECT_EQ(back.blocks, field.blocks);
  expectSameNodes(field, back);
  ASSERT_EQ(back.coarse.size(), field.coarse.size());
  for (std::size_t i = 0; i < back.coarse.size(); ++i) {
    EXPECT_EQ(back.coarse[i].phi, field.coarse[i].phi);
    EXPECT_EQ(back.coarse[i].gz, field.coarse[i].gz);
  }
  EXPECT_TRUE(isField(file("f.vti")));
}

// ParaView's reader: one image, also if a piece stands in the file once for many.
TEST_F(FieldIo, VtkReadsThePiecesAsOneImage) {
  SurfaceField field = sphereField(150);
  ASSERT_GT(field.grid.nodes[0], 128);
  addFaces(field);
  writeField(file("f.vti"), field);
  const vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(file("f.vti").c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  ASSERT_EQ(image->GetNumberOfPoints(), static_cast<vtkIdType>(field.grid.nodeCount()));
  auto* phi = vtkFloatArray::SafeDownCast(image->GetPointData()->GetScalars());
  auto* face = image->GetPointData()->GetArray("face");
  ASSERT_NE(phi, nullptr);
  ASSERT_NE(face, nullptr);
  const double band = field.band * field.grid.voxel;
  vtkIdType node = 0;
  for (int k = 0; k < field.grid.nodes[2]; ++k)
    for (int j = 0; j < field.grid.nodes[1]; ++j)
      for (int i = 0; i < field.grid.nodes[0]; ++i, ++node) {
        const double value = static_cast<double>(test::phiAt(field, i, j, k));
        const double metres = std::clamp(value * field.grid.voxel, -band, band);
        ASSERT_NEAR(static_cast<double>(phi->GetValue(node)), metres, 1e-7 * band);
        ASSERT_EQ(face->GetTuple1(node), field.faceAt(i, j, k));
      }
  expectSameNodes(field, readField(file("f.vti")));
  EXPECT_EQ(readField(file("f.vti")).block_at, field.block_at);
}

TEST_F(FieldIo, RefusesAMovedOrScaledGrid) {
  writeField(file("f.vti"), sphereField());
  const std::string whole = readFile(file("f.vti"));
  for (const std::string name : {"Origin", "Spacing"}) {
    std::string bytes = whole;
    const std::size_t at = bytes.find(name + "=\"") + name.size() + 2;
    bytes.replace(at, bytes.find('"', at) - at, "7 7 7");
    std::ofstream(file("moved.vti"), std::ios::binary) << bytes;
    EXPECT_NE(messageOf(file("moved.vti")).find("its " + name + " was changed"), std::string::npos);
  }
}

TEST_F(FieldIo, KeepsSparseBlocksSparse) {
  SurfaceField field = sphereField();
  field.coarse.clear();
  writeField(file("f.vti"), field);
  const SurfaceField back = readField(file("f.vti"));
  EXPECT_LE(back.blockCount(), field.blockCount());
  EXPECT_LT(back.blockCount(), back.block_index.size());
  EXPECT_TRUE(back.face.empty());
  EXPECT_TRUE(back.coarse.empty());
  EXPECT_EQ(withSamples(std::make_shared<SurfaceField>(back))->sample.size(), back.blockCount());
}

TEST_F(FieldIo, NamesTheFileForEveryTruncation) {
  writeField(file("f.vti"), sphereField());
  const std::string whole = readFile(file("f.vti"));
  for (const double fraction : {0.0, 0.001, 0.01, 0.1, 0.5, 0.9, 0.99}) {
    std::ofstream(file("cut.vti"), std::ios::binary)
        << whole.substr(0, static_cast<std::size_t>(fraction * static_cast<double>(whole.size())));
    const std::string message = messageOf(file("cut.vti"));
    EXPECT_NE(message.find("cut.vti"), std::string::npos) << fraction;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST_F(FieldIo, DamagedBytesNeverCrashAndNeverGiveAnInfiniteField) {
  writeField(file("f.vti"), sphereField());
  const std::string whole = readFile(file("f.vti"));
  std::mt19937 random(11);
  int refused = 0;
  for (int round = 0; round < 60; ++round) {
    std::string bytes = whole;
    // The rounds change the header's numbers and the compressed data in turn.
    const std::size_t range = round % 2 == 0 ? std::size_t{1500} : bytes.size();
    for (int hit = 0; hit < 3; ++hit) bytes[random() % range] = static_cast<char>(random());
    std::ofstream(file("bad.vti"), std::ios::binary) << bytes;
    try {
      const SurfaceField field = readField(file("bad.vti"));
      for (const auto& block : field.distance)
        for (const float phi : block->phi()) ASSERT_TRUE(std::isfinite(phi));
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 20);
}

// One block; every node holds the same.
struct HandMade {
  double voxel = 1e-3;
  float phi = 1e-3F; // [m]
  int rounding = 0;
  float coarse = 1;
};

void writeByHand(const fs::path& path, const HandMade& of) {
  const vtkNew<vtkImageData> image;
  image->SetDimensions(kBlockSide, kBlockSide, kBlockSide);
  image->SetSpacing(of.voxel, of.voxel, of.voxel);
  const auto fill = [](auto* array, const char* name, int components, vtkIdType tuples,
                       double value) {
    array->SetName(name);
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(tuples);
    array->Fill(value);
  };
  const vtkNew<vtkFloatArray> phi, coarse;
  const vtkNew<vtkSignedCharArray> rounding;
  const vtkNew<vtkDoubleArray> grid, band;
  fill(phi.Get(), "phi [m]", 1, kBlockNodes, static_cast<double>(of.phi));
  fill(rounding.Get(), "phi rounding [ulp]", 1, kBlockNodes, of.rounding);
  fill(coarse.Get(), "coarse [voxel]", 4, 8, static_cast<double>(of.coarse));
  fill(band.Get(), "band [voxel]", 1, 1, 8);
  fill(grid.Get(), "grid [m]", 4, 1, 0);
  grid->SetValue(3, of.voxel);
  image->GetPointData()->SetScalars(phi);
  image->GetPointData()->AddArray(rounding);
  for (vtkDataArray* array : std::initializer_list<vtkDataArray*>{coarse, band, grid})
    image->GetFieldData()->AddArray(array);
  const vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(path.c_str());
  ASSERT_EQ(writer->Write(), 1);
}

TEST_F(FieldIo, RefusesNumbersOutsideAFieldsRange) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInfinity = std::numeric_limits<float>::infinity();
  writeByHand(file("good.vti"), {});
  EXPECT_EQ(messageOf(file("good.vti")), "");
  writeByHand(file("beyond.vti"), {.phi = 1e37F, .rounding = 127}); // only its sign counts
  EXPECT_EQ(messageOf(file("beyond.vti")), "");
  for (const HandMade& bad :
       {HandMade{.phi = 1e37F}, HandMade{.phi = -1e37F}, HandMade{.voxel = 1e-300},
        HandMade{.phi = 1e3F}, HandMade{.phi = 0, .rounding = -1}, HandMade{.phi = kNan},
        HandMade{.phi = kNan, .rounding = 127}, HandMade{.coarse = kNan},
        HandMade{.coarse = -kInfinity}}) {
    writeByHand(file("bad.vti"), bad);
    EXPECT_NE(messageOf(file("bad.vti")).find("is damaged"), std::string::npos)
        << bad.voxel << ' ' << bad.phi << ' ' << bad.rounding << ' ' << bad.coarse;
  }
}

TEST_F(FieldIo, RefusesOtherFilesInOneLine) {
  std::ofstream(file("text.vti")) << "solid of hope\n";
  EXPECT_NE(messageOf(file("text.vti")).find("not a VTK XML ImageData"), std::string::npos);
  EXPECT_NE(messageOf(file("none.vti")).find("no such file"), std::string::npos);
  EXPECT_NE(messageOf(fs::temp_directory_path()).find("is a folder"), std::string::npos);
  std::ofstream(file("huge.vti"))
      << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\">\n"
         "<ImageData WholeExtent=\"0 99999999 0 99999999 0 99999999\" Origin=\"0 0 0\" "
         "Spacing=\"1 1 1\"></ImageData></VTKFile>\n";
  EXPECT_NE(messageOf(file("huge.vti")).find("2^30"), std::string::npos);
}

TEST_F(FieldIo, FailedWriteLeavesTheOldFile) {
  writeField(file("f.vti"), sphereField());
  EXPECT_THROW(writeField(file("no/such/folder/f.vti"), sphereField()), FileError);
  EXPECT_TRUE(isField(file("f.vti")));
}

// A density with its solid inside, like a scanner's.
void writeDensity(const fs::path& path) {
  const vtkNew<vtkImageData> image;
  constexpr int kNodes = 48;
  image->SetDimensions(kNodes, kNodes, kNodes);
  image->SetOrigin(-1.5, -1.5, -1.5);
  image->SetSpacing(3.0 / (kNodes - 1), 3.0 / (kNodes - 1), 3.0 / (kNodes - 1));
  const vtkNew<vtkFloatArray> density;
  density->SetName("density");
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i) {
    double p[3];
    image->GetPoint(i, p);
    density->InsertNextValue(static_cast<float>(100 * (1 - Vec3(p).norm())));
  }
  image->GetPointData()->AddArray(density);
  const vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(path.c_str());
  writer->Write();
}

TEST_F(FieldIo, ForeignVolumeGivesAnOutwardSurface) {
  writeDensity(file("v.vti"));
  EXPECT_FALSE(isField(file("v.vti")));
  const VolumeRange range = scalarRange(file("v.vti"));
  EXPECT_LT(range.low, -100);
  EXPECT_GT(range.high, 90);
  const TriangleMesh mesh = isoSurfaceOfVolume(file("v.vti"), 20); // sphere of radius 0.8
  double worst = 0;
  for (const Vec3& p : mesh.positions) worst = std::max(worst, std::abs(p.norm() - 0.8));
  EXPECT_LT(worst, 0.005);
  EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * M_PI * 0.512, 0.02);
}

// Whole numbers, like a scanner's: `value(i, j, k)` at each node.
template <class Array, class Value> void writeWhole(const fs::path& path, const Value& value) {
  const vtkNew<vtkImageData> image;
  constexpr int kNodes = 14;
  image->SetDimensions(kNodes, kNodes, kNodes);
  const vtkNew<Array> numbers;
  numbers->SetName("numbers");
  for (int k = 0; k < kNodes; ++k)
    for (int j = 0; j < kNodes; ++j)
      for (int i = 0; i < kNodes; ++i) {
        const bool rim = std::min({i, j, k}) == 0 || std::max({i, j, k}) == kNodes - 1;
        numbers->InsertNextValue(static_cast<typename Array::ValueType>(rim ? -4 : value(i, j, k)));
      }
  image->GetPointData()->AddArray(numbers);
  const vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(path.c_str());
  writer->Write();
}

TEST_F(FieldIo, WholeNumbersAtAWholeIsoValueGiveAClosedSurface) {
  std::mt19937 random(7);
  const auto ball = [](int i, int j, int k) {
    return std::max(-3, 4 - static_cast<int>((Vec3(i, j, k) - Vec3(6, 7, 6)).norm()));
  };
  const auto noise = [&](int, int, int) { return static_cast<int>(random() % 6) - 3; };
  const auto cubes = [](int i, int j, int k) { return (i / 3 + j / 3 + k / 3) % 2; };
  int round = 0;
  const auto check = [&](const fs::path& path) {
    for (const double iso : {-2.0, 0.0, 1.0}) {
      SCOPED_TRACE(testing::Message() << "volume " << round << ", iso " << iso);
      const TriangleMesh mesh = isoSurfaceOfVolume(path, iso);
      const MeshReport report = inspect(mesh);
      EXPECT_EQ(report.degenerate, 0u);
      EXPECT_TRUE(report.watertight);
      const TriangleMesh other = isoSurfaceOfVolume(path, iso + 1e-9);
      EXPECT_EQ(other.positions, mesh.positions);
      EXPECT_EQ(other.triangles, mesh.triangles);
    }
    ++round;
  };
  writeWhole<vtkShortArray>(file("ball.vti"), ball);
  writeWhole<vtkFloatArray>(file("noise.vti"), noise);
  writeWhole<vtkSignedCharArray>(file("cubes.vti"), cubes);
  writeWhole<vtkDoubleArray>(file("scaled.vti"), ball);
  for (const char* name : {"ball.vti", "noise.vti", "cubes.vti", "scaled.vti"}) check(file(name));
}

TEST_F(FieldIo, HighestAndLowestWholeNumberGiveSurfaces) {
  writeWhole<vtkSignedCharArray>(file("mask.vti"), [](int i, int j, int k) {
    return (Vec3(i, j, k) - Vec3(6, 6, 6)).norm() < 4 ? 1 : 0;
  });
  for (const double iso : {1.0, 1 + 1e-9, 0.5})
    EXPECT_EQ(isoSurfaceOfVolume(file("mask.vti"), iso).positions,
              isoSurfaceOfVolume(file("mask.vti"), 0.5).positions);
  EXPECT_FALSE(isoSurfaceOfVolume(file("mask.vti"), -4).triangles.empty());
}

TEST_F(FieldIo, IsoValueBetweenWholeNumbersIsUsedUnchanged) {
  writeWhole<vtkShortArray>(file("v.vti"), [](int i, int, int) { return 10 * i; });
  double x = 99;
  for (const Vec3& p : isoSurfaceOfVolume(file("v.vti"), 33).positions) x = std::min(x, p.x());
  EXPECT_NEAR(x, 3.3, 1e-6); // no node has 33
}

TEST_F(FieldIo, NumbersOfEveryTypeGiveTheSameSurface) {
  const auto falls = [](int i, int j, int k) {
    return std::max(0, 40 - static_cast<int>(5 * (Vec3(i, j, k) - Vec3(6, 7, 6)).norm()));
  };
  const auto mesh = [&](auto array, const char* name) {
    const vtkNew<vtkImageData> image;
    image->SetDimensions(14, 14, 14);
    array->SetName("numbers");
    for (int k = 0; k < 14; ++k)
      for (int j = 0; j < 14; ++j)
        for (int i = 0; i < 14; ++i) array->InsertNextTuple1(falls(i, j, k));
    image->GetPointData()->AddArray(array);
    const vtkNew<vtkXMLImageDataWriter> writer;
    writer->SetInputData(image);
    writer->SetFileName(file(name).c_str());
    writer->Write();
    return isoSurfaceOfVolume(file(name), 12.3);
  };
  const TriangleMesh truth = mesh(vtkSmartPointer<vtkDoubleArray>::New(), "double.vti");
  ASSERT_GT(truth.triangles.size(), 100u);
  const auto expectTruth = [&](const TriangleMesh& other, const char* name) {
    ASSERT_EQ(other.triangles, truth.triangles) << name;
    for (std::size_t v = 0; v < truth.positions.size(); ++v)
      EXPECT_LT((other.positions[v] - truth.positions[v]).norm(), 1e-5) << name;
  };
  expectTruth(mesh(vtkSmartPointer<vtkUnsignedIntArray>::New(), "a.vti"), "uint32");
  expectTruth(mesh(vtkSmartPointer<vtkUnsignedLongLongArray>::New(), "b.vti"), "uint64");
  expectTruth(mesh(vtkSmartPointer<vtkUnsignedShortArray>::New(), "c.vti"), "uint16");
  expectTruth(mesh(vtkSmartPointer<vtkUnsignedCharArray>::New(), "d.vti"), "uint8");
  expectTruth(mesh(vtkSmartPointer<vtkFloatArray>::New(), "e.vti"), "float32");
}

TEST_F(FieldIo, ExplainsAnIsoValueOutsideTheRange) {
  writeDensity(file("v.vti"));
  try {
    isoSurfaceOfVolume(file("v.vti"), 1000);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("its values run from"), std::string::npos);
  }
  EXPECT_NE(messageOf(file("v.vti")).find("not a Patina field"), std::string::npos);
}

} // namespace
} // namespace patina
