#include "visualization/layers/mirror_layer.h"

#include <vtkCellArray.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "visualization/surfaces/precise_points.h"

namespace patina {
namespace {

vtkSmartPointer<vtkActor> flatActor(vtkPoints& points, bool filled) {
  const vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(filled ? 4 : 5);
  for (vtkIdType i = 0; i < (filled ? 4 : 5); ++i) cells->InsertCellPoint(i % 4);
  const vtkNew<vtkPolyData> data;
  data->SetPoints(&points);
  filled ? data->SetPolys(cells) : data->SetLines(cells);
  const vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  return actor;
}

} // namespace

MirrorLayer::MirrorLayer(vtkRenderer& scene, const MirrorState& place) : scene_(scene) {
  const auto points = precisePoints();
  for (const Vec3& corner : place) points->InsertNextPoint(corner.data());
  fill_ = flatActor(*points, true);
  fill_->GetProperty()->SetColor(palette::forVtk(palette::kIso));
  fill_->GetProperty()->SetOpacity(0.25);
  rim_ = flatActor(*points, false);
  rim_->GetProperty()->SetLineWidth(1.5);
  scene_.AddActor(fill_);
  scene_.AddActor(rim_);
}

MirrorLayer::~MirrorLayer() {
  scene_.RemoveActor(fill_);
  scene_.RemoveActor(rim_);
}

void MirrorLayer::setBackgroundStyle(const palette::BackgroundStyle& ground) {
  rim_->GetProperty()->SetColor(palette::forVtk(ground.shaft));
}

} // namespace patina
