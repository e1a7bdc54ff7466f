#include "visualization/layers/stability_layer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkProperty.h>

#include "visualization/surfaces/surface_data.h"
#include "visualization/values/distance_map.h"
#include "visualization/values/scalar_bar.h"
#include "visualization/values/scene_setup.h"

namespace patina {
namespace {

// One normal per vertex, even at sharp edges, because a vertex has one ratio.
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
  table->SetRange(kMinRatioShown, kMaxRatioShown);
  table->SetNanColor(palette::kToolShaft[0], palette::kToolShaft[1], palette::kToolShaft[2], 1);
  table->SetBelowRangeColor(palette::kUnstable[0], palette::kUnstable[1], palette::kUnstable[2], 1);
  table->SetAboveRangeColor(palette::kSecondary[0], palette::kSecondary[1], palette::kSecondary[2],
                            1);
  table->UseBelowRangeColorOn();
  table->UseAboveRangeColorOn();
  return table;
}

StabilityLayer::StabilityLayer(vtkRenderer& scene, vtkRenderer& overlay)
    : actor_(surfaceActor(palette::kSurface)), bar_(scalarBar("K*/K")) {
  const auto colors = stabilityColors();
  vtkPolyDataMapper& mapper = mapperOf(*actor_);
  mapper.SetLookupTable(colors);
  mapper.UseLookupTableScalarRangeOn();
  mapper.ScalarVisibilityOn();
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
    float shown = std::clamp(ratio[v], static_cast<float>(kMinRatioShown),
                             static_cast<float>(kMaxRatioShown)); // NaN stays NaN
    if (ratio[v] == kUnstable) shown = 0.1F * static_cast<float>(kMinRatioShown);
    if (ratio[v] == kNotTouchable) shown = 10 * static_cast<float>(kMaxRatioShown);
    jumps = jumps || std::isnan(ratio[v]);
    slips = slips || ratio[v] == kUnstable;
    untouched = untouched || ratio[v] == kNotTouchable;
    values->SetValue(static_cast<vtkIdType>(v), shown);
  }
  tags_ = jumps || slips || untouched;
  bar_->SetDrawNanAnnotation(jumps);
  bar_->SetDrawBelowRangeSwatch(slips);
  bar_->SetDrawAboveRangeSwatch(untouched);
  data->GetPointData()->SetScalars(values);
  mapperOf(*actor_).SetInputData(data);
}

} // namespace patina
