#include "visualization/surface_data.h"

#include <cmath>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt32Array.h>

namespace patina {
namespace {

// Twice the area times the unit normal: summing these weighs each face by its area.
std::vector<Vec3> areaNormals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.triangles.size());
  for (std::size_t f = 0; f < normals.size(); ++f) {
    const Vec3 a = mesh.corner(f, 0);
    normals[f] = (mesh.corner(f, 1) - a).cross(mesh.corner(f, 2) - a);
  }
  return normals;
}

// Corners around each vertex: those of vertex v are corners[first[v]] .. corners[first[v + 1] - 1].
struct Fans {
  std::vector<std::int32_t> first, corners; // a corner is 3 * face + which
};

Fans fansOf(const TriangleMesh& mesh, const std::vector<bool>& usable) {
  Fans fans;
  fans.first.assign(mesh.positions.size() + 1, 0);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    if (usable[f])
      for (const std::int32_t v : mesh.triangles[f]) ++fans.first[static_cast<std::size_t>(v) + 1];
  for (std::size_t v = 1; v < fans.first.size(); ++v) fans.first[v] += fans.first[v - 1];
  fans.corners.resize(static_cast<std::size_t>(fans.first.back()));
  std::vector<std::int32_t> next(fans.first.begin(), fans.first.end() - 1);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    if (usable[f])
      for (std::size_t k = 0; k < 3; ++k) {
        auto& slot = next[static_cast<std::size_t>(mesh.triangles[f][k])];
        fans.corners[static_cast<std::size_t>(slot++)] = static_cast<std::int32_t>(3 * f + k);
      }
  return fans;
}

vtkSmartPointer<vtkCellArray> cells(vtkTypeInt32Array* connectivity, std::size_t triangles) {
  auto offsets = vtkSmartPointer<vtkTypeInt32Array>::New();
  offsets->SetNumberOfValues(static_cast<vtkIdType>(triangles + 1));
  for (std::size_t f = 0; f <= triangles; ++f)
    offsets->SetValue(static_cast<vtkIdType>(f), static_cast<std::int32_t>(3 * f));
  auto array = vtkSmartPointer<vtkCellArray>::New();
  array->SetData(offsets, connectivity);
  return array;
}

} // namespace

vtkSmartPointer<vtkPolyData> surfaceData(const TriangleMesh& mesh, double crease_deg) {
  const std::vector<Vec3> face_normals = areaNormals(mesh);
  std::vector<bool> usable(mesh.triangles.size());
  std::size_t count = 0;
  for (std::size_t f = 0; f < usable.size(); ++f) {
    usable[f] = face_normals[f].allFinite();
    if (usable[f]) ++count;
  }
  const Fans fans = fansOf(mesh, usable);
  const double cosine = std::cos(crease_deg * M_PI / 180);

  std::vector<float> points, normals;
  points.reserve(mesh.positions.size() * 3);
  normals.reserve(mesh.positions.size() * 3);
  std::vector<std::int32_t> drawn_vertex(mesh.triangles.size() * 3, -1);
  std::vector<std::pair<Vec3, std::int32_t>> made; // normals of this vertex so far
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    made.clear();
    for (std::int32_t at = fans.first[v]; at < fans.first[v + 1]; ++at) {
      const std::int32_t corner = fans.corners[static_cast<std::size_t>(at)];
      const Vec3& own = face_normals[static_cast<std::size_t>(corner / 3)];
      Vec3 sum = Vec3::Zero();
      for (std::int32_t other = fans.first[v]; other < fans.first[v + 1]; ++other) {
        const Vec3& n = face_normals[static_cast<std::size_t>(
            fans.corners[static_cast<std::size_t>(other)] / 3)];
        if (own.dot(n) >= cosine * own.norm() * n.norm()) sum += n;
      }
      // Corners that saw the same neighbours summed them in the same order: equal bit for bit.
      std::int32_t index = -1;
      for (const auto& [normal, where] : made)
        if (normal == sum) index = where;
      if (index < 0) {
        index = static_cast<std::int32_t>(points.size() / 3);
        made.emplace_back(sum, index);
        const Vec3 unit = sum.norm() > 0 ? Vec3(sum.normalized()) : Vec3::UnitZ();
        for (int axis = 0; axis < 3; ++axis) {
          points.push_back(static_cast<float>(mesh.positions[v][axis]));
          normals.push_back(static_cast<float>(unit[axis]));
        }
      }
      drawn_vertex[static_cast<std::size_t>(corner)] = index;
    }
  }

  const auto vertices = static_cast<vtkIdType>(points.size() / 3);
  const vtkNew<vtkFloatArray> point_array;
  point_array->SetNumberOfComponents(3);
  point_array->SetNumberOfTuples(vertices);
  std::copy(points.begin(), points.end(), point_array->GetPointer(0));
  const vtkNew<vtkFloatArray> normal_array;
  normal_array->SetName("Normals");
  normal_array->SetNumberOfComponents(3);
  normal_array->SetNumberOfTuples(vertices);
  std::copy(normals.begin(), normals.end(), normal_array->GetPointer(0));
  const vtkNew<vtkTypeInt32Array> connectivity;
  connectivity->SetNumberOfValues(static_cast<vtkIdType>(3 * count));
  vtkIdType next = 0;
  for (const std::int32_t vertex : drawn_vertex)
    if (vertex >= 0) connectivity->SetValue(next++, vertex);

  auto data = vtkSmartPointer<vtkPolyData>::New();
  const vtkNew<vtkPoints> vtk_points;
  vtk_points->SetData(point_array);
  data->SetPoints(vtk_points);
  data->GetPointData()->SetNormals(normal_array);
  data->SetPolys(cells(connectivity, count));
  return data;
}

vtkSmartPointer<vtkPolyData> plainData(const TriangleMesh& mesh) {
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.positions.size()));
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    points->SetPoint(static_cast<vtkIdType>(v), mesh.positions[v].data());
  const vtkNew<vtkTypeInt32Array> connectivity;
  connectivity->SetNumberOfValues(static_cast<vtkIdType>(3 * mesh.triangles.size()));
  vtkIdType next = 0;
  for (const Triangle& triangle : mesh.triangles)
    for (const std::int32_t vertex : triangle) connectivity->SetValue(next++, vertex);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells(connectivity, mesh.triangles.size()));
  return data;
}

} // namespace patina
