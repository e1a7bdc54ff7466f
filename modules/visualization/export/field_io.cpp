#include "visualization/export/field_io.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkSignedCharArray.h>
#include <vtkSmartPointer.h>

#include "core/error.h"
#include "field/store/node_reader.h"
#include "visualization/export/volume_file.h"
#include "visualization/export/xml_file.h"

namespace patina {
namespace {

constexpr const char* kPhi = "phi [m]";
constexpr const char* kRounding = "phi rounding [ulp]";
constexpr const char* kFace = "face";
constexpr const char* kGrid = "grid [m]";
constexpr const char* kBand = "band [voxel]";
constexpr const char* kCoarse = "coarse [voxel]";
constexpr signed char kBeyond = 127;

float metres(float voxels, double voxel) {
  return static_cast<float>(static_cast<double>(voxels) * voxel);
}
float voxels(float metres, double voxel) {
  return static_cast<float>(static_cast<double>(metres) / voxel);
}

// Floats of one sign are ordered as their bit patterns, so a step of one ulp is a step of one.
int ulpsBetween(float from, float to) {
  std::int32_t a = 0, b = 0;
  std::memcpy(&a, &from, sizeof a);
  std::memcpy(&b, &to, sizeof b);
  return b - a;
}
float stepped(float value, int ulps) {
  std::int32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  bits += ulps;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

template <typename Array>
vtkSmartPointer<Array> namedArray(const char* name, int components, std::size_t tuples) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(tuples));
  return array;
}

template <typename Array, typename Data>
Array* requireArray(Data* data, const char* name, vtkIdType values,
                    const std::filesystem::path& path) {
  auto* array = Array::SafeDownCast(data->GetAbstractArray(name));
  if (array == nullptr)
    throw FileError(path.string(), 0,
                    std::string("is not a Patina field: array '") + name + "' is missing");
  if (values >= 0 && array->GetNumberOfValues() != values)
    throw FileError(path.string(), 0,
                    std::string("is not a Patina field: array '") + name + "' has a wrong size");
  return array;
}

FieldGrid readGrid(vtkImageData* image, const std::filesystem::path& path) {
  const auto* values = requireArray<vtkDoubleArray>(image->GetFieldData(), kGrid, 4, path);
  FieldGrid grid;
  for (int axis = 0; axis < 3; ++axis) {
    grid.origin[axis] = values->GetValue(axis);
    grid.nodes[static_cast<std::size_t>(axis)] = image->GetDimensions()[axis];
    if (grid.nodes[static_cast<std::size_t>(axis)] < 2)
      throw FileError(path.string(), 0, "is not a Patina field: fewer than two nodes on an axis");
  }
  grid.voxel = values->GetValue(3);
  if (!grid.origin.allFinite() || !std::isfinite(grid.voxel) || grid.voxel <= 0)
    throw FileError(path.string(), 0, "is not a Patina field: its voxel is not a positive length");
  return grid;
}

// What one block of the file says; nothing in it within the band means that it is not stored.
struct BlockReader {
  const std::filesystem::path& path;
  const FieldGrid& grid;
  const float* phi;
  const signed char* rounding;
  const int* face; // nullptr without one
  std::array<int, 3> first{};

  // False if every node is beyond the band; `inside` is then the sign that the nodes share.
  bool read(DistanceNodes& distance, FaceNodes& faces, bool& inside) const {
    bool stored = false;
    std::size_t at = 0;
    for (int k = first[2]; k < first[2] + kBlockSide; ++k)
      for (int j = first[1]; j < first[1] + kBlockSide; ++j)
        for (int i = first[0]; i < first[0] + kBlockSide; ++i, ++at) {
          distance.phi[at] = kBeyondBand;
          faces.face[at] = -1;
          if (i >= grid.nodes[0] || j >= grid.nodes[1] || k >= grid.nodes[2]) continue;
          const std::size_t node =
              (static_cast<std::size_t>(k) * static_cast<std::size_t>(grid.nodes[1]) +
               static_cast<std::size_t>(j)) *
                  static_cast<std::size_t>(grid.nodes[0]) +
              static_cast<std::size_t>(i);
          if (!std::isfinite(phi[node]))
            throw FileError(path.string(), 0, "is damaged: a distance is not a number");
          if (rounding[node] == kBeyond) {
            inside = phi[node] < 0;
            distance.phi[at] = inside ? -kBeyondBand : kBeyondBand;
            continue;
          }
          distance.phi[at] = stepped(voxels(phi[node], grid.voxel), rounding[node]);
          if (!(std::abs(distance.phi[at]) < kBeyondBand))
            throw FileError(path.string(), 0, "is damaged: a distance is beyond any band");
          if (face != nullptr) faces.face[at] = face[node];
          stored = true;
        }
    return stored;
  }
};

} // namespace

void writeField(const std::filesystem::path& path, const SurfaceField& field) {
  const FieldGrid& grid = field.grid;
  const std::size_t count = grid.nodeCount();
  const auto phi = namedArray<vtkFloatArray>(kPhi, 1, count);
  const auto rounding = namedArray<vtkSignedCharArray>(kRounding, 1, count);
  const bool has_face = !field.face.empty();
  const auto face = namedArray<vtkIntArray>(kFace, 1, has_face ? count : 0);
  const float band_metres = static_cast<float>(field.band * grid.voxel);
  const NodeReader nodes(field);
  vtkIdType node = 0;
  for (int k = 0; k < grid.nodes[2]; ++k)
    for (int j = 0; j < grid.nodes[1]; ++j)
      for (int i = 0; i < grid.nodes[0]; ++i, ++node) {
        const float value = nodes.phiAt(i, j, k);
        if (has_face) face->SetValue(node, field.faceAt(i, j, k));
        if (std::abs(value) >= kBeyondBand) {
          phi->SetValue(node, std::copysign(band_metres, value));
          rounding->SetValue(node, kBeyond);
        } else {
          phi->SetValue(node, metres(value, grid.voxel));
          rounding->SetValue(node, static_cast<signed char>(ulpsBetween(
                                       voxels(metres(value, grid.voxel), grid.voxel), value)));
        }
      }
  const vtkNew<vtkImageData> image;
  image->SetDimensions(grid.nodes.data());
  image->SetOrigin(grid.origin.data());
  image->SetSpacing(grid.voxel, grid.voxel, grid.voxel);
  image->GetPointData()->SetScalars(phi);
  image->GetPointData()->AddArray(rounding);
  if (has_face) image->GetPointData()->AddArray(face);

  // The XML header prints origin and spacing in fewer digits than they have.
  const auto exact_grid = namedArray<vtkDoubleArray>(kGrid, 4, 1);
  for (int axis = 0; axis < 3; ++axis) exact_grid->SetValue(axis, grid.origin[axis]);
  exact_grid->SetValue(3, grid.voxel);
  image->GetFieldData()->AddArray(exact_grid);
  const auto band = namedArray<vtkDoubleArray>(kBand, 1, 1);
  band->SetValue(0, field.band);
  image->GetFieldData()->AddArray(band);
  if (!field.coarse.empty()) {
    const auto coarse = namedArray<vtkFloatArray>(kCoarse, 4, field.coarse.size());
    std::memcpy(coarse->GetPointer(0), field.coarse.data(),
                field.coarse.size() * sizeof(CoarseNode));
    image->GetFieldData()->AddArray(coarse);
  }

  writeImageData(path, image);
}

SurfaceField readField(const std::filesystem::path& path) {
  const vtkSmartPointer<vtkImageData> image = readVolume(path);
  const vtkIdType count = image->GetNumberOfPoints();
  auto* points = image->GetPointData();
  SurfaceField field;
  field.grid = readGrid(image, path);
  const auto* band = requireArray<vtkDoubleArray>(image->GetFieldData(), kBand, 1, path);
  field.band = band->GetValue(0);
  if (!std::isfinite(field.band) || field.band <= 0)
    throw FileError(path.string(), 0, "is not a Patina field: its band is not a positive number");

  const bool has_face = points->HasArray(kFace) != 0;
  BlockReader reader{
      path,
      field.grid,
      requireArray<vtkFloatArray>(points, kPhi, count, path)->GetPointer(0),
      requireArray<vtkSignedCharArray>(points, kRounding, count, path)->GetPointer(0),
      has_face ? requireArray<vtkIntArray>(points, kFace, count, path)->GetPointer(0) : nullptr,
      {}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    field.blocks[axis] = (field.grid.nodes[axis] + kBlockSide - 1) / kBlockSide;
  for (int bz = 0; bz < field.blocks[2]; ++bz)
    for (int by = 0; by < field.blocks[1]; ++by)
      for (int bx = 0; bx < field.blocks[0]; ++bx) {
        reader.first = {bx * kBlockSide, by * kBlockSide, bz * kBlockSide};
        DistanceNodes distance;
        FaceNodes faces{};
        bool inside = false;
        if (!reader.read(distance, faces, inside)) {
          field.top.push_back(inside ? SurfaceField::kInside : SurfaceField::kOutside);
          continue;
        }
        field.top.push_back(static_cast<std::int32_t>(field.block_at.size()));
        field.block_at.push_back({bx, by, bz});
        field.distance.push_back(std::make_shared<const DistanceBlock>(distance));
        if (has_face) field.face.push_back(std::make_shared<const FaceBlock>(faces));
      }

  if (image->GetFieldData()->HasArray(kCoarse) != 0) {
    const std::size_t nodes = static_cast<std::size_t>(field.blocks[0] + 1) *
                              static_cast<std::size_t>(field.blocks[1] + 1) *
                              static_cast<std::size_t>(field.blocks[2] + 1);
    auto* coarse = requireArray<vtkFloatArray>(image->GetFieldData(), kCoarse,
                                               static_cast<vtkIdType>(nodes * 4), path);
    field.coarse.resize(nodes);
    std::memcpy(field.coarse.data(), coarse->GetPointer(0), nodes * sizeof(CoarseNode));
    const float* values = coarse->GetPointer(0);
    if (!std::all_of(values, values + 4 * nodes, [](float value) { return std::isfinite(value); }))
      throw FileError(path.string(), 0, "is damaged: a coarse distance is not a number");
  }
  return field;
}

bool isField(const std::filesystem::path& path) {
  const vtkSmartPointer<vtkImageData> image = readVolume(path);
  return image->GetPointData()->HasArray(kPhi) != 0 &&
         image->GetPointData()->HasArray(kRounding) != 0 &&
         image->GetFieldData()->HasArray(kGrid) != 0;
}

} // namespace patina
