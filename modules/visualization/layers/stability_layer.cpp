#include "visualization/layers/stability_layer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "visualization/surfaces/surface_data.h"
#include "visualization/values/distance_map.h"
#include "visualization/values/palette.h"
#include "visualization/values/scalar_bar.h"
#include "visualization/view/scene_furniture.h"

namespace patina {
namespace {

// One normal a vertex, however sharp the edge: a vertex has one ratio too.
vtkSmartPointer<vtkFloatArray> vertexNormals(const TriangleMesh& mesh) {
  std::vector<Vec3> sum(mesh.positions.size(), Vec3::Zero());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Vec3 a = mesh.corner(f, 0);
    const Vec3 area = (mesh.corner(f, 1) - a).cross(mesh.corner(f, 2) - a);
    if (!area.allFinite()) continue;
    for (const std::int32_t v : mesh.triangles[f]) sum[static_cast<std::size_t>(v)] += area;
  }
  auto normals = vtkSmartPointer<vtkFloatArray>::New();
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(static_cast<vtkIdType>(sum.size()));
  for (std::size_t v = 0; v < sum.size(); ++v) {
    const Vec3 unit = sum[v].norm() > 0 ? Vec3(sum[v].normalized()) : Vec3::UnitZ();
    normals->SetTuple(static_cast<vtkIdType>(v), unit.data());
  }
  return normals;
}

} // namespace

vtkSmartPointer<vtkLookupTable> stabilityColors() {
  const auto table = divergingColors();
  table->SetScaleToLog10();
  table->SetRange(kLeastRatioShown, kMostRatioShown);
  table->SetNanColor(palette::kToolShaft[0], palette::kToolShaft[1], palette::kToolShaft[2], 1);
  table->SetBelowRangeColor(palette::kSlips[0], palette::kSlips[1], palette::kSlips[2], 1);
  table->SetAboveRangeColor(palette::kQuiet[0], palette::kQuiet[1], palette::kQuiet[2], 1);
  table->UseBelowRangeColorOn();
  table->UseAboveRangeColorOn();
  return table;
}

StabilityLayer::StabilityLayer(vtkRenderer& scene, vtkRenderer& overlay)
    : actor_(surfaceActor(palette::kSurface)), bar_(scalarBar("K*/K")) {
  const auto colors = stabilityColors();
  auto* mapper = vtkPolyDataMapper::SafeDownCast(actor_->GetMapper());
  mapper->SetLookupTable(colors);
  mapper->UseLookupTableScalarRangeOn();
  mapper->ScalarVisibilityOn();
  // Shine would shift colours that are to be read.
  actor_->GetProperty()->SetSpecular(0);
  actor_->GetProperty()->SetAmbient(0.3);
  scene.AddActor(actor_);
  bar_->SetLookupTable(colors);
  bar_->SetLabelFormat("%.3g");
  bar_->SetNanAnnotation("jumps");
  bar_->SetBelowRangeAnnotation("slips off");
  bar_->SetAboveRangeAnnotation("untouched");
  overlay.AddActor2D(bar_);
  setVisible(false);
}

void StabilityLayer::update(const TriangleMesh& surface, const std::vector<float>& ratio) {
  if (ratio.size() != surface.positions.size())
    throw std::invalid_argument("stability layer: one ratio a vertex");
  const auto data = plainData(surface);
  data->GetPointData()->SetNormals(vertexNormals(surface));
  const vtkNew<vtkFloatArray> values;
  values->SetName("stability [K*/K]");
  values->SetNumberOfValues(static_cast<vtkIdType>(ratio.size()));
  bool jumps = false, slips = false, untouched = false;
  for (std::size_t v = 0; v < ratio.size(); ++v) {
    float shown = std::clamp(ratio[v], static_cast<float>(kLeastRatioShown),
                             static_cast<float>(kMostRatioShown)); // a NaN stays
    if (ratio[v] == kSlips) shown = 0.1F * static_cast<float>(kLeastRatioShown);
    if (ratio[v] == kUntouched) shown = 10 * static_cast<float>(kMostRatioShown);
    jumps = jumps || std::isnan(ratio[v]);
    slips = slips || ratio[v] == kSlips;
    untouched = untouched || ratio[v] == kUntouched;
    values->SetValue(static_cast<vtkIdType>(v), shown);
  }
  tags_ = jumps || slips || untouched;
  bar_->SetDrawNanAnnotation(jumps);
  bar_->SetDrawBelowRangeSwatch(slips);
  bar_->SetDrawAboveRangeSwatch(untouched);
  data->GetPointData()->SetScalars(values);
  vtkPolyDataMapper::SafeDownCast(actor_->GetMapper())->SetInputData(data);
}

void StabilityLayer::setVisible(bool on) {
  actor_->SetVisibility(on);
  bar_->SetVisibility(on);
}

} // namespace patina
