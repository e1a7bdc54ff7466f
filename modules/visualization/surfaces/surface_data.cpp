#include "visualization/surfaces/surface_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkTypeInt32Array.h>

#include "visualization/surfaces/precise_points.h"

namespace patina {
namespace {

// Twice the area times the unit normal; a sum of these weights each face by its area.
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
  std::vector<std::int32_t> first, corners; // a corner is 3 * face + index
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

struct Made {
  Vec3 normal;
  Vec2 uv;
  std::int32_t index;
};

vtkSmartPointer<vtkFloatArray> floats(const std::vector<float>& values, int components,
                                      const char* name) {
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

// Merges corners of a vertex with the same normal and texture coordinates into one point.
vtkSmartPointer<vtkPolyData> splitData(const TriangleMesh& mesh,
                                       const CornerNormals& corner_normals, const CornerUvs* uvs,
                                       std::vector<std::int32_t>* vertex_of_point) {
  std::vector<bool> usable(mesh.triangles.size());
  for (std::size_t f = 0; f < usable.size(); ++f) usable[f] = corner_normals[f][0].allFinite();
  const auto count = static_cast<std::size_t>(std::count(usable.begin(), usable.end(), true));
  const Fans fans = fansOf(mesh, usable);
  const auto points = precisePoints();
  points->Allocate(static_cast<vtkIdType>(mesh.positions.size()));
  std::vector<float> normals, coordinates;
  normals.reserve(mesh.positions.size() * 3);
  std::vector<std::int32_t> drawn_vertex(mesh.triangles.size() * 3, -1);
  std::vector<Made> made; // points of this vertex so far
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    made.clear();
    for (std::int32_t at = fans.first[v]; at < fans.first[v + 1]; ++at) {
      const auto corner = static_cast<std::size_t>(fans.corners[static_cast<std::size_t>(at)]);
      const Vec3& normal = corner_normals[corner / 3][corner % 3];
      const Vec2 uv = uvs != nullptr ? Vec2((*uvs)[corner / 3][corner % 3]) : Vec2::Zero();
      std::int32_t index = -1;
      for (const Made& one : made)
        if (one.normal == normal && one.uv == uv) index = one.index;
      if (index < 0) {
        index = static_cast<std::int32_t>(points->InsertNextPoint(mesh.positions[v].data()));
        made.push_back({normal, uv, index});
        const Vec3 unit = normal.norm() > 0 ? Vec3(normal.normalized()) : Vec3::UnitZ();
        for (int axis = 0; axis < 3; ++axis) normals.push_back(static_cast<float>(unit[axis]));
        if (uvs != nullptr)
          for (int axis = 0; axis < 2; ++axis) coordinates.push_back(static_cast<float>(uv[axis]));
        if (vertex_of_point != nullptr) vertex_of_point->push_back(static_cast<std::int32_t>(v));
      }
      drawn_vertex[corner] = index;
    }
  }

  const vtkNew<vtkTypeInt32Array> connectivity;
  connectivity->SetNumberOfValues(static_cast<vtkIdType>(3 * count));
  vtkIdType next = 0;
  for (const std::int32_t vertex : drawn_vertex)
    if (vertex >= 0) connectivity->SetValue(next++, vertex);

  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->GetPointData()->SetNormals(floats(normals, 3, "Normals"));
  if (uvs != nullptr)
    data->GetPointData()->SetTCoords(floats(coordinates, 2, "Texture coordinates"));
  data->SetPolys(cells(connectivity, count));
  return data;
}

// Vertex clustering (Rossignac & Borrel 1993): merges the vertices in each cell of a grid with
// `cells` along the longest side into their mean. Degenerate triangles and those with a corner that
// is not finite are removed.
TriangleMesh coarsened(const TriangleMesh& mesh, int cells) {
  TriangleMesh coarse;
  const Box3 box = bounds(mesh);
  if (box.isEmpty()) return coarse;
  const double side = std::max(box.sizes().maxCoeff() / cells, 1e-300);
  std::unordered_map<std::int64_t, std::int32_t> vertex_in;
  std::vector<double> count;
  std::vector<std::int32_t> vertex_of(mesh.positions.size(), -1);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    if (!p.allFinite() || !box.contains(p)) continue;
    const Eigen::Matrix<std::int64_t, 3, 1> cell =
        ((p - box.min()) / side).array().floor().cast<std::int64_t>();
    const std::int64_t across = cells + 1;
    const auto [at, is_new] =
        vertex_in.try_emplace((cell[0] * across + cell[1]) * across + cell[2],
                              static_cast<std::int32_t>(coarse.positions.size()));
    if (is_new) {
      coarse.positions.emplace_back(Vec3::Zero());
      count.push_back(0);
    }
    vertex_of[v] = at->second;
    coarse.positions[static_cast<std::size_t>(at->second)] += p;
    ++count[static_cast<std::size_t>(at->second)];
  }
  for (std::size_t v = 0; v < count.size(); ++v) coarse.positions[v] /= count[v];
  for (const Triangle& triangle : mesh.triangles) {
    Triangle made;
    for (std::size_t k = 0; k < 3; ++k) made[k] = vertex_of[static_cast<std::size_t>(triangle[k])];
    const bool whole = made[0] >= 0 && made[1] >= 0 && made[2] >= 0;
    if (whole && made[0] != made[1] && made[1] != made[2] && made[2] != made[0])
      coarse.triangles.push_back(made);
  }
  return coarse;
}

} // namespace

CornerNormals smoothNormals(const TriangleMesh& mesh, double crease_deg) {
  const std::vector<Vec3> face_normals = areaNormals(mesh);
  std::vector<bool> usable(mesh.triangles.size());
  for (std::size_t f = 0; f < usable.size(); ++f) usable[f] = face_normals[f].allFinite();
  const Fans fans = fansOf(mesh, usable);
  const double cosine = std::cos(crease_deg * M_PI / 180);
  const Vec3 none = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  CornerNormals normals(mesh.triangles.size(), {none, none, none});
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    for (std::int32_t at = fans.first[v]; at < fans.first[v + 1]; ++at) {
      const auto corner = static_cast<std::size_t>(fans.corners[static_cast<std::size_t>(at)]);
      const Vec3& own = face_normals[corner / 3];
      Vec3 sum = Vec3::Zero();
      for (std::int32_t other = fans.first[v]; other < fans.first[v + 1]; ++other) {
        const Vec3& n = face_normals[static_cast<std::size_t>(
            fans.corners[static_cast<std::size_t>(other)] / 3)];
        if (own.dot(n) >= cosine * own.norm() * n.norm()) sum += n;
      }
      // Corners with the same neighbours sum them in the same order: equal bit for bit.
      normals[corner / 3][corner % 3] = sum.norm() > 0 ? Vec3(sum.normalized()) : Vec3::Zero();
    }
  return normals;
}

vtkSmartPointer<vtkPolyData> surfaceData(const TriangleMesh& mesh, double crease_deg) {
  return splitData(mesh, smoothNormals(mesh, crease_deg), nullptr, nullptr);
}

vtkSmartPointer<vtkPolyData> texturedData(const TriangleMesh& mesh, const CornerUvs& uvs) {
  return splitData(mesh, smoothNormals(mesh), &uvs, nullptr);
}

vtkSmartPointer<vtkPolyData> surfaceData(const TriangleMesh& mesh, const CornerNormals& normals,
                                         std::vector<std::int32_t>& vertex_of_point) {
  vertex_of_point.clear();
  return splitData(mesh, normals, nullptr, &vertex_of_point);
}

vtkSmartPointer<vtkPolyData> coarseData(const TriangleMesh& mesh, int cells) {
  return surfaceData(coarsened(mesh, cells));
}

vtkSmartPointer<vtkPolyData> plainData(const TriangleMesh& mesh) {
  const auto points = precisePoints();
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
