#include "visualization/layers/scale_layer.h"

#include <cmath>

#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkTextProperty.h>

#include "core/numbers.h"

namespace patina {
namespace {
constexpr double kMost = 11; // max width in heights of a line of text
} // namespace

double roundLength(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= most) return factor * power;
  return power;
}

ScaleLayer::ScaleLayer(vtkRenderer& overlay)
    : bar_(vtkSmartPointer<vtkActor2D>::New()), words_(vtkSmartPointer<vtkTextActor>::New()) {
  const vtkNew<vtkPolyDataMapper2D> mapper;
  // the picture may be drawn before its height is known
  mapper->SetInputData(vtkNew<vtkPolyData>());
  bar_->SetMapper(mapper);
  words_->GetTextProperty()->SetJustificationToCentered();
  words_->GetTextProperty()->SetVerticalJustificationToBottom();
  overlay.AddActor2D(bar_);
  overlay.AddActor2D(words_);
  setVisible(false);
}

void ScaleLayer::update(vtkCamera& camera, int high, const TextStyle& letters) {
  const double half = camera.GetParallelProjection() != 0
                          ? camera.GetParallelScale()
                          : camera.GetDistance() * std::tan(camera.GetViewAngle() * M_PI / 360);
  if (!(half > 0) || high <= 0) return;
  const double pixel = 2 * half / high; // [m]
  const double length = roundLength(kMost * letters.pixels * pixel);
  // Bracket at the lower edge, right of the axes.
  const double left = 10.0 * letters.pixels, low = 0.9 * letters.pixels;
  const double right = left + length / pixel, tick = 0.45 * letters.pixels;
  const vtkNew<vtkPoints> points;
  const vtkNew<vtkCellArray> line;
  const double corners[][2] = {{left, low + tick}, {left, low}, {right, low}, {right, low + tick}};
  line->InsertNextCell(4);
  for (const auto& corner : corners)
    line->InsertCellPoint(points->InsertNextPoint(corner[0], corner[1], 0));
  const vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(line);
  vtkPolyDataMapper2D::SafeDownCast(bar_->GetMapper())->SetInputData(data);
  bar_->GetProperty()->SetColor(palette::forVtk(letters.ground.text));
  bar_->GetProperty()->SetLineWidth(static_cast<float>(0.14 * letters.pixels));
  write(*words_->GetTextProperty(), letters, letters.ground.text, true);
  // Invisible on the background, but legible in front of a body.
  words_->GetTextProperty()->SetBackgroundColor(palette::forVtk(letters.ground.low));
  words_->GetTextProperty()->SetBackgroundOpacity(letters.ground.plates ? 0.8 : 0);
  std::string text = formatLength(length);
  if (const auto at = text.find(" um"); at != std::string::npos) text.replace(at, 3, " \xC2\xB5m");
  words_->SetInput(text.c_str());
  words_->SetPosition((left + right) / 2, low + 0.5 * letters.pixels);
}

} // namespace patina
