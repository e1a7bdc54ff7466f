#include "visualization/layers/path_layer.h"

#include <algorithm>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>
#include <vtkTubeFilter.h>

#include "visualization/surfaces/precise_points.h"
#include "visualization/values/color_table.h"
#include "visualization/values/paint_quantity.h"
#include "visualization/values/scalar_bar.h"
#include "visualization/values/scene_setup.h"

namespace patina {
namespace {

constexpr double kThick = 0.007, kMarkRadius = 0.016; // radii, fractions of the path's extent
constexpr double kPalest = 0.22;    // fraction of the colours at the pale end that is left out
constexpr double kStep = 1. / 1200; // fraction of the extent; nearer samples are merged

Box3 boxOf(const std::vector<DrawnSample>& samples) {
  Box3 box;
  for (const DrawnSample& sample : samples) box.extend(sample.position);
  return box;
}

double sizeOf(const Box3& box) {
  return box.isEmpty() ? 0.1 : std::max(box.diagonal().norm(), 5e-3);
}

std::vector<DrawnSample> thinned(const std::vector<DrawnSample>& samples) {
  const double step = kStep * sizeOf(boxOf(samples));
  std::vector<DrawnSample> kept;
  bool begins = true;
  for (const DrawnSample& sample : samples) {
    begins = begins || sample.begins;
    const bool same = !kept.empty() && !begins && sample.bridged == kept.back().bridged;
    const double way = kept.empty() ? 0 : (sample.position - kept.back().position).norm();
    if ((same && way < step) || (!kept.empty() && !begins && way == 0)) continue;
    kept.push_back(sample);
    kept.back().begins = begins;
    begins = false;
  }
  return kept;
}

vtkSmartPointer<vtkPolyData> linesThrough(vtkPoints* points, vtkCellArray* lines,
                                          vtkDoubleArray* values) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  data->GetPointData()->SetScalars(values);
  return data;
}

// Lines of bridged samples, or of the others, each from the sample before it.
vtkSmartPointer<vtkPolyData> linesOf(const std::vector<DrawnSample>& samples, bool bridged) {
  const auto points = precisePoints();
  const vtkNew<vtkCellArray> lines;
  const vtkNew<vtkDoubleArray> values;
  values->SetName("value");
  std::vector<vtkIdType> line;
  const auto add = [&](const DrawnSample& sample) {
    line.push_back(points->InsertNextPoint(sample.position.data()));
    values->InsertNextValue(sample.value);
  };
  const auto end = [&] {
    if (line.size() > 1) lines->InsertNextCell(static_cast<vtkIdType>(line.size()), line.data());
    line.clear();
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].begins) end();
    if (samples[i].bridged != bridged) {
      if (bridged || !line.empty()) {
        if (bridged && !line.empty()) add(samples[i]);
        end();
      }
      continue;
    }
    if (line.empty() && i > 0 && !samples[i].begins) add(samples[i - 1]);
    add(samples[i]);
  }
  end();
  return linesThrough(points, lines, values);
}

vtkSmartPointer<vtkPolyData> residualsOf(const std::vector<DrawnSample>& samples, double stretch) {
  const auto points = precisePoints();
  const vtkNew<vtkCellArray> lines;
  const vtkNew<vtkDoubleArray> values;
  for (const DrawnSample& sample : samples) {
    if (!sample.foot || !(stretch > 0)) continue;
    const Vec3 end = *sample.foot + stretch * (sample.position - *sample.foot);
    lines->InsertNextCell(2);
    for (const Vec3* point : {&*sample.foot, &end}) {
      lines->InsertCellPoint(points->InsertNextPoint(point->data()));
      values->InsertNextValue(sample.value);
    }
  }
  return linesThrough(points, lines, values);
}

// Colours of the path and of the error map. Dark means a high value; the palest colours are left
// out, because thin lines would not show them.
vtkSmartPointer<vtkLookupTable> pathColors(const ColorScale& scale, const ValueRange& range) {
  if (scale.map != ColorMap::standard || scale.bands > 0 || scale.reversed || scale.logarithmic) {
    const auto table = colorTable(scale, StandardMap::sequential, range);
    table->SetNanColor(palette::kNoValue[0], palette::kNoValue[1], palette::kNoValue[2], 1);
    return table;
  }
  const auto all = paintColors(PaintQuantity::first_channel, range);
  auto colors = vtkSmartPointer<vtkLookupTable>::New();
  colors->SetNumberOfTableValues(256);
  colors->SetRange(range.low, range.high);
  colors->SetNanColor(palette::kNoValue[0], palette::kNoValue[1], palette::kNoValue[2], 1);
  for (int i = 0; i < 256; ++i) {
    double color[4];
    const double part = kPalest + (1 - kPalest) * i / 255;
    all->GetTableValue(static_cast<vtkIdType>(part * (all->GetNumberOfTableValues() - 1)), color);
    colors->SetTableValue(i, color);
  }
  return colors;
}

} // namespace

PathLayer::PathLayer(vtkRenderer& scene, vtkRenderer& overlay)
    : tube_(surfaceActor(palette::kForce)), line_(surfaceActor(palette::kForce)),
      overlay_line_(surfaceActor(palette::kToolShaft)), bridge_(surfaceActor(palette::kSecondary)),
      residuals_(surfaceActor(palette::kForce)), mark_actor_(vtkSmartPointer<vtkActor>::New()),
      mark_mapper_(vtkSmartPointer<vtkGlyph3DMapper>::New()), bar_(scalarBar("")) {
  tube_->GetProperty()->SetAmbient(0.35);
  line_->GetProperty()->SetLineWidth(3);
  bridge_->GetProperty()->SetLineWidth(2);
  overlay_line_->GetProperty()->SetLineWidth(1.5);
  residuals_->GetProperty()->SetLineWidth(1.5);
  for (const auto& actor : {line_, overlay_line_, bridge_, residuals_})
    actor->GetProperty()->LightingOff();
  const vtkNew<vtkSphereSource> ball;
  ball->SetRadius(1);
  mark_mapper_->SetSourceConnection(ball->GetOutputPort());
  mark_mapper_->ScalarVisibilityOff();
  mark_mapper_->SetInputData(vtkSmartPointer<vtkPolyData>::New());
  mark_actor_->SetMapper(mark_mapper_);
  mark_actor_->GetProperty()->SetColor(palette::forVtk(palette::kForce));
  for (const auto& actor : {tube_, line_, bridge_, residuals_, mark_actor_}) scene.AddActor(actor);
  overlay.AddActor(overlay_line_);
  bar_->SetLabelFormat("%.3g");
  bar_->SetVisibility(false);
  overlay.AddActor2D(bar_);
}

void PathLayer::setPath(const DrawnPath& path) {
  drawn_ = thinned(path.samples);
  title_ = path.title;
  ValueRange range{INFINITY, -INFINITY};
  for (const DrawnSample& sample : drawn_) {
    if (!std::isfinite(sample.value)) continue;
    range.low = std::min(range.low, sample.value);
    range.high = std::max(range.high, sample.value);
  }
  const bool has_values = range.low <= range.high;
  has_bar_ = has_values && path.bar;
  bar_->SetVisibility(has_bar_);
  const vtkNew<vtkTubeFilter> tube;
  const auto lines = linesOf(drawn_, false);
  tube->SetInputData(lines);
  tube->SetRadius(kThick * sizeOf(boxOf(drawn_)));
  tube->SetNumberOfSides(8);
  tube->CappingOn();
  tube->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  tube->Update();
  mapperOf(*tube_).SetInputData(tube->GetOutput());
  mapperOf(*line_).SetInputData(lines);
  const vtkNew<vtkPolyData> overlay_line; // without values: one colour
  overlay_line->SetPoints(lines->GetPoints());
  if (path.show_through) overlay_line->SetLines(lines->GetLines());
  mapperOf(*overlay_line_).SetInputData(overlay_line);
  mapperOf(*bridge_).SetInputData(linesOf(drawn_, true));
  mapperOf(*residuals_).SetInputData(residualsOf(drawn_, path.stretch));
  colors_ = nullptr;
  setMarks(marks_);
  if (!has_values) return;
  range.high = std::max(range.high, range.low + path.min_span);
  std::vector<double> values;
  for (const DrawnSample& sample : drawn_)
    if (std::isfinite(sample.value)) values.push_back(sample.value);
  std::sort(values.begin(), values.end());
  range = shownRange(path.scale, rounded(range), values);
  colors_ = pathColors(path.scale, range);
  bar_->SetLabelFormat(labelFormat(path.scale, "%.3g").c_str());
  for (const auto& actor : {tube_, line_, residuals_}) {
    mapperOf(*actor).ScalarVisibilityOn();
    mapperOf(*actor).SetLookupTable(colors_);
    mapperOf(*actor).UseLookupTableScalarRangeOn();
  }
  bar_->SetLookupTable(colors_);
  setTitle(*bar_, path.title);
}

void PathLayer::setMarks(const std::vector<DrawnMark>& marks) {
  marks_ = marks;
  const auto points = precisePoints();
  // VTK places glyphs in floats, so positions are relative to the first mark, at the actor.
  const Vec3 middle = marks.empty() ? Vec3::Zero() : marks[0].position;
  for (const DrawnMark& mark : marks)
    points->InsertNextPoint((mark.position - middle).eval().data());
  mark_actor_->SetPosition(middle[0], middle[1], middle[2]);
  const vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  mark_mapper_->SetInputData(data);
  mark_mapper_->SetScaleFactor(kMarkRadius * sizeOf(boxOf(drawn_)));
}

Box3 PathLayer::extent() const {
  return boxOf(drawn_);
}

std::optional<DrawnSample> PathLayer::sampleAt(vtkRenderer& scene, double x, double y,
                                               double reach) const {
  double nearest = reach * reach;
  std::optional<DrawnSample> found;
  const auto look = [&](const DrawnSample& sample) {
    scene.SetWorldPoint(sample.position.x(), sample.position.y(), sample.position.z(), 1);
    scene.WorldToDisplay();
    const double* pixel = scene.GetDisplayPoint();
    const double squared = (pixel[0] - x) * (pixel[0] - x) + (pixel[1] - y) * (pixel[1] - y);
    if (squared >= nearest) return;
    nearest = squared;
    found = sample;
  };
  for (const DrawnSample& sample : drawn_) look(sample);
  for (const DrawnMark& mark : marks_) look({mark.t, mark.position, NAN});
  return found;
}

} // namespace patina
