#include "visualization/layers/annotation_layer.h"

#include <vtkCellArray.h>
#include <vtkCoordinate.h>
#include <vtkProperty.h>
#include <vtkTextProperty.h>

#include "visualization/surfaces/precise_points.h"
#include "visualization/values/scene_setup.h"

namespace patina {
namespace {

constexpr float kDotSize = 9, kLineWidth = 2.5F; // [pixels]

// One cell through all points, or one cell a point.
vtkSmartPointer<vtkPolyData> dataOf(const std::vector<Vec3>& list, bool as_line) {
  const auto points = precisePoints();
  const vtkNew<vtkCellArray> cells;
  if (as_line) cells->InsertNextCell(static_cast<int>(list.size()));
  for (const Vec3& p : list) {
    const vtkIdType id = points->InsertNextPoint(p.data());
    as_line ? cells->InsertCellPoint(id) : void(cells->InsertNextCell(1, &id));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  as_line ? data->SetLines(cells) : data->SetVerts(cells);
  return data;
}

} // namespace

std::vector<Annotation> pinAnnotations(const std::vector<Pin>& pins) {
  std::vector<Annotation> drawn;
  for (const Pin& pin : pins) drawn.push_back({{pin.position}, {}, pin.name, palette::kSeries[0]});
  return drawn;
}

AnnotationLayer::AnnotationLayer(vtkRenderer& overlay) : overlay_(overlay) {}

AnnotationLayer::~AnnotationLayer() {
  clear();
}

void AnnotationLayer::clear() {
  for (const Drawn& drawn : drawn_) {
    overlay_.RemoveActor(drawn.dots);
    overlay_.RemoveActor(drawn.line);
    overlay_.RemoveActor2D(drawn.label);
  }
  drawn_.clear();
}

void AnnotationLayer::set(const std::vector<Annotation>& annotations) {
  clear();
  for (const Annotation& each : annotations) {
    Drawn drawn{surfaceActor(each.color), surfaceActor(each.color),
                vtkSmartPointer<vtkTextActor>::New(), each.color};
    for (const auto& actor : {drawn.dots, drawn.line}) {
      actor->GetProperty()->LightingOff();
      overlay_.AddActor(actor);
    }
    drawn.dots->GetProperty()->SetPointSize(kDotSize);
    drawn.dots->GetProperty()->RenderPointsAsSpheresOn();
    drawn.line->GetProperty()->SetLineWidth(kLineWidth);
    mapperOf(*drawn.dots).SetInputData(dataOf(each.points, false));
    if (each.line.size() > 1) mapperOf(*drawn.line).SetInputData(dataOf(each.line, true));
    drawn.line->SetVisibility(each.line.size() > 1);
    const bool named = !each.label.empty() && !each.points.empty();
    drawn.label->SetVisibility(named);
    if (named) {
      drawn.label->SetInput((" " + each.label + " ").c_str());
      const vtkNew<vtkCoordinate> dot; // the label is beside it, in pixels
      dot->SetCoordinateSystemToWorld();
      const Vec3& at = each.points.back();
      dot->SetValue(at.x(), at.y(), at.z());
      vtkCoordinate* beside = drawn.label->GetPositionCoordinate();
      beside->SetCoordinateSystemToViewport();
      beside->SetReferenceCoordinate(dot);
      beside->SetValue(kDotSize, kDotSize);
      drawn.label->GetTextProperty()->BoldOn();
    }
    overlay_.AddActor2D(drawn.label);
    drawn_.push_back(drawn);
  }
}

void AnnotationLayer::setTextStyle(const TextStyle& letters) {
  for (const Drawn& drawn : drawn_)
    write(*drawn.label->GetTextProperty(), letters, drawn.color, true);
}

} // namespace patina
