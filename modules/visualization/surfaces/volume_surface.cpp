#include <cmath>

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSetGet.h>

#include "core/error.h"
#include "core/numbers.h"
#include "visualization/files/field_io.h"
#include "visualization/files/volume_file.h"

namespace patina {
namespace {

vtkDataArray* scalarsOf(vtkImageData* image, const std::filesystem::path& path) {
  auto* points = image->GetPointData();
  vtkDataArray* scalars = points->GetScalars();
  for (int i = 0; scalars == nullptr && i < points->GetNumberOfArrays(); ++i)
    scalars = points->GetArray(i);
  if (scalars == nullptr)
    throw FileError(path.string(), 0,
                    "has no values at its nodes (point data) to take a surface of");
  if (scalars->GetNumberOfComponents() != 1)
    throw FileError(path.string(), 0, "has several values a node; a surface needs one");
  return scalars;
}

VolumeRange rangeOf(vtkDataArray* scalars) {
  VolumeRange range;
  double values[2] = {0, 0};
  scalars->GetFiniteRange(values, 0);
  range.low = values[0];
  range.high = values[1];
  return range;
}

// Calls visit(values, count) with the array's own type.
template <class Visit> void withValues(vtkDataArray* scalars, const Visit& visit) {
  const auto count = static_cast<std::size_t>(scalars->GetNumberOfTuples());
  switch (scalars->GetDataType()) {
    vtkTemplateMacro(visit(static_cast<const VTK_TT*>(scalars->GetVoidPointer(0)), count));
  }
}

bool isWideUnsigned(int type) {
  return type == VTK_UNSIGNED_INT || type == VTK_UNSIGNED_LONG || type == VTK_UNSIGNED_LONG_LONG;
}

// Returns the value at which the surface is taken. If all values are integers and some equal `iso`,
// the surface would pass through nodes and have degenerate triangles and parts that touch in a
// point. Such nodes then count as higher: the value is lowered by half a step, or raised if no
// value is lower. An `iso` that differs by rounding gives the same surface.
double withoutTies(vtkDataArray* scalars, double iso) {
  constexpr double kTieRounding = 1e-6; // fraction of an integer step
  const double whole = std::round(iso);
  if (!(std::abs(iso - whole) <= kTieRounding)) return iso;
  bool all_whole = true, tie = false, lower = false;
  withValues(scalars, [&](const auto* values, std::size_t count) {
    for (std::size_t i = 0; all_whole && i < count; ++i) {
      const auto value = static_cast<double>(values[i]);
      all_whole = value == std::floor(value) || !std::isfinite(value);
      tie |= value == whole;
      lower |= value < whole;
    }
  });
  if (!all_whole || !tie) return iso;
  return lower ? whole - 0.5 : whole + 0.5;
}

} // namespace

VolumeRange scalarRange(const std::filesystem::path& path) {
  const auto image = readVolume(path);
  return rangeOf(scalarsOf(image, path));
}

TriangleMesh isoSurfaceOfVolume(const std::filesystem::path& path, double iso) {
  const auto image = readVolume(path);
  auto* scalars = scalarsOf(image, path);
  const int* nodes = image->GetDimensions();
  if (nodes[0] < 2 || nodes[1] < 2 || nodes[2] < 2)
    throw FileError(path.string(), 0, "is flat: a surface needs two nodes or more on each axis");
  // Flying edges (Schroeder et al. 2015) subtracts neighbours in the array's own type, in which
  // wide unsigned values wrap.
  vtkSmartPointer<vtkDataArray> values = scalars;
  if (isWideUnsigned(scalars->GetDataType())) {
    values = vtkSmartPointer<vtkDoubleArray>::New();
    values->DeepCopy(scalars);
  }
  image->GetPointData()->SetScalars(values);

  const vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(image);
  contour->SetValue(0, withoutTies(scalars, iso));
  contour->ComputeNormalsOff();
  contour->ComputeScalarsOff();
  contour->Update();
  vtkPolyData* surface = contour->GetOutput();

  TriangleMesh mesh;
  mesh.positions.resize(static_cast<std::size_t>(surface->GetNumberOfPoints()));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    surface->GetPoint(static_cast<vtkIdType>(i), mesh.positions[i].data());
  mesh.triangles.reserve(static_cast<std::size_t>(surface->GetNumberOfPolys()));
  vtkIdType size = 0;
  const vtkIdType* corner = nullptr;
  auto* polygons = surface->GetPolys();
  for (polygons->InitTraversal(); polygons->GetNextCell(size, corner) != 0;)
    if (size == 3)
      mesh.triangles.push_back({static_cast<std::int32_t>(corner[0]),
                                static_cast<std::int32_t>(corner[1]),
                                static_cast<std::int32_t>(corner[2])});
  if (mesh.triangles.empty()) {
    const VolumeRange range = rangeOf(scalars);
    throw FileError(path.string(), 0,
                    "has no surface at " + formatNumber(iso) + ": its values run from " +
                        formatNumber(range.low) + " to " + formatNumber(range.high));
  }
  // A distance grows outwards, a density inwards; contact needs outward normals for both.
  if (volume(mesh) < 0)
    for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

} // namespace patina
