#include "visualization/export/export_paint.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include "scene/paint/grey_relief.h"
#include "visualization/export/xml_file.h"
#include "visualization/surfaces/refined_surface.h"
#include "visualization/values/paint_quantity.h"
#include "visualization/values/palette.h"

namespace patina {
namespace {

constexpr std::size_t kMaxExported = 500'000;

vtkSmartPointer<vtkDoubleArray> values(PaintQuantity quantity, vtkIdType count) {
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(arrayName(quantity).c_str());
  array->SetNumberOfValues(count);
  return array;
}

// Side of a texel on the surface if the whole image is used [m].
double texelSide(const TriangleMesh& mesh, const TiledImage& image) {
  return std::sqrt(area(mesh) / (static_cast<double>(image.width()) * image.height()));
}

RefinedSurface fineSurface(const SceneObject& object) {
  const ObjectPaint& paint = *object.paint;
  TriangleMesh mesh = *object.mesh;
  mesh.corner_uvs = paint.layout.uvs ? *paint.layout.uvs : CornerUvs{};
  double edge = std::numeric_limits<double>::infinity();
  for (const auto& image : {paint.color, paint.relief})
    if (image && paint.layout.uvs) edge = std::min(edge, texelSide(mesh, *image));
  if (paint.material) edge = std::min(edge, paint.material->voxel());
  return refined(mesh, edge > 0 ? edge : 1, kMaxExported);
}

// Surface vertices, repeated for each of their texture coordinates.
struct Points {
  std::vector<std::int32_t> vertex;
  std::vector<Vec2> uv;
  std::vector<std::int32_t> of_corner; // 3 per triangle
};

Points pointsOf(const TriangleMesh& mesh) {
  Points points;
  std::vector<std::vector<std::int32_t>> made(mesh.positions.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t vertex = mesh.triangles[f][k];
      const Vec2 uv = mesh.corner_uvs.empty() ? Vec2(Vec2::Zero()) : mesh.corner_uvs[f][k];
      std::vector<std::int32_t>& same = made[static_cast<std::size_t>(vertex)];
      auto found = std::find_if(same.begin(), same.end(), [&](std::int32_t point) {
        return points.uv[static_cast<std::size_t>(point)] == uv;
      });
      if (found == same.end()) {
        same.push_back(static_cast<std::int32_t>(points.vertex.size()));
        points.vertex.push_back(vertex);
        points.uv.push_back(uv);
        found = same.end() - 1;
      }
      points.of_corner.push_back(*found);
    }
  return points;
}

void addImages(vtkPointData& data, const ObjectPaint& paint, const Points& points, double height) {
  const auto count = static_cast<vtkIdType>(points.uv.size());
  const vtkNew<vtkFloatArray> coordinates;
  coordinates->SetName("texture coordinates");
  coordinates->SetNumberOfComponents(2);
  coordinates->SetNumberOfTuples(count);
  for (vtkIdType p = 0; p < count; ++p)
    coordinates->SetTuple(p, points.uv[static_cast<std::size_t>(p)].data());
  data.SetTCoords(coordinates);
  if (paint.color) {
    const vtkNew<vtkUnsignedCharArray> color;
    color->SetName(arrayName(PaintQuantity::color).c_str());
    color->SetNumberOfComponents(3);
    color->SetNumberOfTuples(count);
    for (vtkIdType p = 0; p < count; ++p) {
      const Vec2& uv = points.uv[static_cast<std::size_t>(p)];
      const double bare = 1 - paint.color->sample(uv[0], uv[1], 3);
      for (int c = 0; c < 3; ++c) {
        const double seen = paint.color->sample(uv[0], uv[1], c) +
                            bare * palette::kSurface[static_cast<std::size_t>(c)];
        color->SetTypedComponent(
            p, c, static_cast<unsigned char>(std::lround(255 * std::clamp(seen, 0.0, 1.0))));
      }
    }
    data.AddArray(color);
  }
  if (paint.relief) {
    const auto relief = values(PaintQuantity::relief, count);
    for (vtkIdType p = 0; p < count; ++p) {
      const Vec2& uv = points.uv[static_cast<std::size_t>(p)];
      relief->SetValue(p, height * paint.relief->sample(uv[0], uv[1], 0));
    }
    data.AddArray(relief);
  }
}

} // namespace

void writePaintVtp(const std::filesystem::path& path, const Scene& scene, std::size_t object) {
  SceneObject one = scene.objects.at(object);
  one.paint = withRelief(one.paint, scene.relief.source);
  if (!one.paint) throw std::invalid_argument("writePaintVtp: nothing is painted");
  const RefinedSurface fine = fineSurface(one);
  const Points points = pointsOf(fine.mesh);
  const auto count = static_cast<vtkIdType>(points.vertex.size());
  const auto at = [&](vtkIdType point) -> const Vec3& {
    return fine.mesh
        .positions[static_cast<std::size_t>(points.vertex[static_cast<std::size_t>(point)])];
  };

  const vtkNew<vtkPolyData> data;
  const vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  places->SetNumberOfPoints(count);
  for (vtkIdType p = 0; p < count; ++p)
    places->SetPoint(p, Vec3(one.world_from_object * at(p)).data());
  data->SetPoints(places);
  const vtkNew<vtkCellArray> triangles;
  const vtkNew<vtkIntArray> face;
  face->SetName("face");
  for (std::size_t t = 0; t < fine.parent.size(); ++t) {
    const vtkIdType corners[3] = {points.of_corner[3 * t], points.of_corner[3 * t + 1],
                                  points.of_corner[3 * t + 2]};
    triangles->InsertNextCell(3, corners);
    face->InsertNextValue(fine.parent[t]);
  }
  data->SetPolys(triangles);
  data->GetCellData()->AddArray(face);
  if (one.paint->layout.uvs)
    addImages(*data->GetPointData(), *one.paint, points, scene.relief.height);
  if (const MaterialMap* map = one.paint->material.get()) {
    const Material base = baseMaterial(scene.haptics);
    std::vector<Material> felt;
    for (vtkIdType p = 0; p < count; ++p) felt.push_back(map->at(at(p), base));
    for (const MaterialChannel channel : kAllMaterialChannels) {
      if (!map->has(channel)) continue;
      const auto array = values(quantityOf(channel), count);
      for (vtkIdType p = 0; p < count; ++p)
        array->SetValue(p, valueOf(felt[static_cast<std::size_t>(p)], channel));
      data->GetPointData()->AddArray(array);
    }
  }
  writePolyData(path, data);
}

void writeMaterialVti(const std::filesystem::path& path, const Scene& scene, std::size_t object) {
  const SceneObject& one = scene.objects.at(object);
  const MaterialMap* map = one.paint ? one.paint->material.get() : nullptr;
  if (map == nullptr || map->blocks().empty())
    throw std::invalid_argument("writeMaterialVti: no material is painted");
  MaterialMap::Index low = map->blocks().begin()->first, high = low;
  for (const auto& [index, block] : map->blocks())
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], index[axis]);
      high[axis] = std::max(high[axis], index[axis]);
    }
  std::array<vtkIdType, 3> nodes{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    nodes[axis] = kMaterialSide * (vtkIdType{high[axis]} - low[axis] + 1);

  const vtkNew<vtkImageData> image;
  image->SetDimensions(static_cast<int>(nodes[0]), static_cast<int>(nodes[1]),
                       static_cast<int>(nodes[2]));
  image->SetSpacing(map->voxel(), map->voxel(), map->voxel());
  const Vec3 first = map->origin() + map->voxel() * kMaterialSide * Vec3(low[0], low[1], low[2]);
  image->SetOrigin(Vec3(one.world_from_object * first).data());
  const Eigen::Matrix3d turn = one.world_from_object.linear();
  image->SetDirectionMatrix(turn(0, 0), turn(0, 1), turn(0, 2), turn(1, 0), turn(1, 1), turn(1, 2),
                            turn(2, 0), turn(2, 1), turn(2, 2));

  const Material base = baseMaterial(scene.haptics);
  for (const MaterialChannel channel : kAllMaterialChannels) {
    if (!map->has(channel)) continue;
    const auto array = values(quantityOf(channel), nodes[0] * nodes[1] * nodes[2]);
    const double own = valueOf(base, channel);
    array->FillValue(own);
    for (const auto& [index, block] : map->blocks()) {
      const MaterialLayer* layer = block.layer[static_cast<std::size_t>(channel)].get();
      if (layer == nullptr) continue;
      for (std::size_t n = 0; n < kMaterialNodes; ++n) {
        const Index3 node =
            BlockNode{{index[0] - low[0], index[1] - low[1], index[2] - low[2]}, n}.at();
        array->SetValue((node[2] * nodes[1] + node[1]) * nodes[0] + node[0],
                        compositedAt(*layer, n, own, rangeOf(channel)));
      }
    }
    image->GetPointData()->AddArray(array);
  }
  writeImageData(path, image);
}

} // namespace patina
