#include "visualization/layers/node_layer.h"

#include <algorithm>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkProperty.h>

#include "field/store/node_reader.h"
#include "visualization/surfaces/precise_points.h"
#include "visualization/values/distance_map.h"

namespace patina {
namespace {

constexpr double kRadius = 5; // voxels: a few hundred nodes, the cell and its neighbourhood

} // namespace

std::vector<FieldNode> nodesNear(const SurfaceField& field, const Vec3& point,
                                 double radius_voxels) {
  std::vector<FieldNode> nodes;
  const Vec3 q = field.grid.toGrid(point);
  if (!q.allFinite()) return nodes;
  std::array<int, 3> low{}, high{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double last = field.grid.nodes[a] - 1;
    low[a] = static_cast<int>(std::clamp(std::ceil(q[axis] - radius_voxels), 0.0, last));
    high[a] = static_cast<int>(std::clamp(std::floor(q[axis] + radius_voxels), 0.0, last));
  }
  const NodeReader reader(field);
  for (int k = low[2]; k <= high[2]; ++k)
    for (int j = low[1]; j <= high[1]; ++j)
      for (int i = low[0]; i <= high[0]; ++i) {
        const Vec3 node(i, j, k);
        const float phi = reader.phiAt(i, j, k);
        if ((node - q).norm() <= radius_voxels && std::abs(phi) < kBackground)
          nodes.push_back({field.grid.toWorld(node), phi});
      }
  return nodes;
}

NodeLayer::NodeLayer(vtkRenderer& overlay)
    : data_(vtkSmartPointer<vtkPolyData>::New()),
      mapper_(vtkSmartPointer<vtkPolyDataMapper>::New()), actor_(vtkSmartPointer<vtkActor>::New()) {
  mapper_->SetInputData(data_);
  mapper_->UseLookupTableScalarRangeOn();
  actor_->SetMapper(mapper_);
  actor_->GetProperty()->SetPointSize(5);
  actor_->GetProperty()->RenderPointsAsSpheresOn();
  actor_->GetProperty()->SetAmbient(0.5);
  overlay.AddActor(actor_);
  setVisible(false);
}

void NodeLayer::update(const SurfaceField& field, const Vec3& tip) {
  const auto points = precisePoints();
  const vtkNew<vtkCellArray> vertices;
  const vtkNew<vtkFloatArray> distance;
  for (const FieldNode& node : nodesNear(field, tip, kRadius)) {
    const vtkIdType id = points->InsertNextPoint(node.position.data());
    vertices->InsertNextCell(1, &id);
    distance->InsertNextValue(static_cast<float>(1000 * node.phi * field.grid.voxel));
  }
  data_->SetPoints(points);
  data_->SetVerts(vertices);
  data_->GetPointData()->SetScalars(distance);
  // Narrower than the slice's map, because near the surface the sign matters.
  mapper_->SetLookupTable(distanceMap(500 * field.grid.voxel * kRadius));
}

} // namespace patina
